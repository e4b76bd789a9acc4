#include "study/run_batch.hpp"

#include <fcntl.h>
#include <signal.h>  // NOLINT: kill() is POSIX, not of <csignal>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <thread>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "scenario/print.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

fs::path error_file(const fs::path& directory, const BatchRun& run) {
  return directory / "runs" / (run.id + ".stderr.txt");
}

// Start `plica run`. Returns -1 if no process can be started.
pid_t start(const fs::path& directory, const BatchRun& run, int threads) {
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  std::vector<std::string> words = {"plica",
                                    "run",
                                    (directory / "runs" / (run.id + ".toml")).string(),
                                    "--out",
                                    (directory / "runs" / run.id).string(),
                                    "--quiet",
                                    "--overwrite",
                                    "--threads",
                                    std::to_string(threads)};
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, error_file(directory, run).c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0644);
  pid_t child = -1;
  const int error = ::posix_spawn(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  return error == 0 ? child : -1;
}

BatchOutcome outcome_of(const fs::path& directory, const BatchRun& run, int status) {
  BatchOutcome outcome;
  if (WIFEXITED(status)) outcome.exit_status = WEXITSTATUS(status);
  const fs::path file = error_file(directory, run);
  if (fs::exists(file)) outcome.message = read_file(file);
  if (outcome.message.empty()) fs::remove(file);
  return outcome;
}

}  // namespace

std::vector<BatchOutcome> run_batch(const fs::path& directory, const std::vector<BatchRun>& runs, Workers workers,
                                    const std::function<void(std::size_t done, const BatchRun& run)>& tell,
                                    const std::function<bool()>& interrupted) {
  std::error_code error;
  fs::create_directories(directory / "runs", error);
  if (error) throw FileError(directory.string() + ": cannot be created: " + error.message());
  std::vector<BatchOutcome> outcomes(runs.size());
  std::map<pid_t, std::size_t> under_way;
  std::size_t next = 0, done = 0;
  bool stopping = false;
  while (!under_way.empty() || (next < runs.size() && !stopping)) {
    if (interrupted() && !stopping) {
      stopping = true;
      for (const auto& [child, index] : under_way) ::kill(child, SIGTERM);
    }
    while (!stopping && next < runs.size() && under_way.size() < static_cast<std::size_t>(workers.processes)) {
      write_file(directory / "runs" / (runs[next].id + ".toml"), resolved_toml(runs[next].scenario));
      const pid_t child = start(directory, runs[next], workers.threads);
      if (child > 0)
        under_way[child] = next;
      else
        outcomes[next].message = "cannot start a process";
      ++next;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    for (auto entry = under_way.begin(); entry != under_way.end();) {
      int status = 0;
      if (::waitpid(entry->first, &status, WNOHANG) != entry->first) {
        ++entry;
        continue;
      }
      outcomes[entry->second] = outcome_of(directory, runs[entry->second], status);
      tell(++done, runs[entry->second]);
      entry = under_way.erase(entry);
    }
  }
  return outcomes;
}

}  // namespace plica
