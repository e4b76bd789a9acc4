#include "study/worker_pool.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/child_process.hpp"
#include "core/errors.hpp"

namespace plica {
namespace {

volatile std::sig_atomic_t told_to_stop = 0;

void note_stop(int) { told_to_stop = 1; }

bool read_all(int end, void* data, std::size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t count = ::recv(end, at, size, 0);
    if (count < 0 && errno == EINTR && told_to_stop == 0) continue;
    if (count <= 0) return false;
    at += count, size -= static_cast<std::size_t>(count);
  }
  return true;
}

// Answers: their length, then a letter for the kind (r: result, f: FileError), and a text.
bool send_answer(int end, const std::string& answer) {
  const std::uint64_t size = answer.size();
  return write_all(end, &size, sizeof size) && write_all(end, answer.data(), answer.size());
}

// Empty if the process has ended.
std::string read_answer(int end) {
  std::uint64_t size = 0;
  if (!read_all(end, &size, sizeof size)) return "";
  std::string answer(size, ' ');
  return read_all(end, answer.data(), size) ? answer : "";
}

// Request long time slices for more workers than cores: each switch refills the caches. With the usual 3 ms four
// workers on two cores took 13 % more time than one per core, with these no more. Linux before 6.12 has no such option.
void ask_for_long_turns() {
  struct {
    std::uint32_t size = 48, policy = SCHED_OTHER;
    std::uint64_t flags = 0;
    std::int32_t nice = 0;
    std::uint32_t priority = 0;
    std::uint64_t runtime_ns = 100'000'000, deadline_ns = 0, period_ns = 0;
  } attributes;
  attributes.nice = ::getpriority(PRIO_PROCESS, 0);
  ::syscall(SYS_sched_setattr, 0, &attributes, 0);
}

int run_worker(int end, const std::function<std::string(std::size_t)>& do_work) {
  ask_for_long_turns();
  std::signal(SIGINT, SIG_IGN);  // of the terminal: the parent decides when to stop
  struct sigaction action = {};
  action.sa_handler = note_stop;  // without SA_RESTART: one that waits for work ends
  ::sigaction(SIGTERM, &action, nullptr);
  std::uint64_t piece = 0;
  while (told_to_stop == 0 && read_all(end, &piece, sizeof piece)) {
    try {
      const std::string answer = 'r' + do_work(static_cast<std::size_t>(piece));
      if (told_to_stop != 0 || !send_answer(end, answer)) break;
    } catch (const FileError& error) {
      send_answer(end, std::string("f") + error.what());
      break;
    }
  }
  return 0;
}

class Worker {
 public:
  Worker(const std::function<std::string(std::size_t)>& do_work, const std::vector<int>& ends_of_others)
      : process_([&](int end) {
          for (const int other : ends_of_others) ::close(other);  // else these would not see their parent's end closed
          return run_worker(end, do_work);
        }) {}

  void give(std::size_t piece) {
    piece_ = piece;
    const std::uint64_t number = piece;
    write_all(process_.end(), &number, sizeof number);  // a process that has ended is noticed when its answer is read
  }
  [[nodiscard]] int end() const { return process_.end(); }
  [[nodiscard]] std::optional<std::size_t> piece() const { return piece_; }

  [[nodiscard]] std::string answer() {
    std::string answer = read_answer(end());
    if (!answer.empty()) piece_.reset();
    return answer;
  }

  void stop() const { process_.send(SIGTERM); }

  // Wait for the process. Returns how it ended.
  std::string ended() {
    const int status = process_.wait();
    if (WIFSIGNALED(status)) return fmt::format("signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
    return fmt::format("status {}", WEXITSTATUS(status));
  }

 private:
  ChildProcess process_;
  std::optional<std::size_t> piece_;
};

}  // namespace

bool worker_is_to_stop() { return told_to_stop != 0; }

void work_in_processes(int workers, std::span<const std::size_t> pieces,
                       const std::function<std::string(std::size_t)>& do_work, const WorkerHooks& hooks) {
  std::deque<std::size_t> open(pieces.begin(), pieces.end());
  std::map<std::size_t, int> ends_over;  // how often a process ended over a piece
  std::vector<std::unique_ptr<Worker>> pool;
  const auto under_way = [&] {
    return std::ranges::any_of(pool, [](const auto& worker) { return worker->piece().has_value(); });
  };
  const auto give = [&](Worker& worker) {
    if (open.empty()) return;
    worker.give(open.front());
    open.pop_front();
  };
  while (!open.empty() || under_way()) {
    if (hooks.stop_requested && hooks.stop_requested()) {
      for (const auto& worker : pool) worker->stop();  // all at once; then each is waited for
      return;
    }
    while (pool.size() < static_cast<std::size_t>(workers) && !open.empty()) {
      std::vector<int> ends;
      ends.reserve(pool.size());
      for (const auto& worker : pool) ends.push_back(worker->end());
      pool.push_back(std::make_unique<Worker>(do_work, ends));
      give(*pool.back());
    }
    std::vector<pollfd> waits_for;
    waits_for.reserve(pool.size());
    for (const auto& worker : pool) waits_for.push_back({worker->end(), POLLIN, 0});
    ::poll(waits_for.data(), waits_for.size(), 100);
    for (std::size_t w = pool.size(); w-- > 0;) {
      if (waits_for[w].revents == 0) continue;
      const std::optional<std::size_t> piece = pool[w]->piece();
      const std::string answer = pool[w]->answer();
      if (answer.starts_with('f')) throw FileError(answer.substr(1));
      if (!answer.empty()) {
        hooks.on_answer(*piece, answer.substr(1), "");
        give(*pool[w]);
        continue;
      }
      const std::string how = pool[w]->ended();
      pool.erase(pool.begin() + static_cast<long>(w));
      if (!piece) continue;
      if (++ends_over[*piece] < 2)
        open.push_front(*piece);
      else
        hooks.on_answer(*piece, "", "its process ended twice, the second time by " + how);
    }
  }
}

}  // namespace plica
