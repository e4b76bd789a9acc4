#include "record/reading_trial.hpp"

#include <sys/resource.h>

#include <new>
#include <string>

#include "core/child_process.hpp"
#include "core/errors.hpp"

namespace plica {
namespace {

/// Of the processor: seconds, and a second for each 10 MB, a hundred times what it takes.
void limit_time(std::size_t bytes) {
  const rlim_t seconds = 3 + bytes / 10'000'000;
  const rlimit limit{seconds, seconds + 1};
  ::setrlimit(RLIMIT_CPU, &limit);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
}

}  // namespace

void read_on_trial(const std::function<void()>& read, std::size_t bytes) {
  // A letter for the kind of answer, then the error.
  const std::optional<std::string> answer = output_of_child("reading it on trial", [&]() -> std::string {
    limit_time(bytes);
    try {
      read();
      return "r";
    } catch (const FileError& error) {
      return std::string("f") + error.what();
    } catch (const std::bad_alloc&) {
      return "m";
    }
  });
  if (!answer || answer->empty()) throw FileError("it is damaged: HDF5 breaks off at it");
  if (answer->front() == 'f') throw FileError(answer->substr(1));
  if (answer->front() == 'm') throw std::bad_alloc();
}

}  // namespace plica
