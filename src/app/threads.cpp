#include "app/threads.hpp"

#include <omp.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#include "core/threads.hpp"

namespace plica {
namespace {

// Restart the program with the same arguments and short waits of threads, unless the user has set these. Returns if it
// cannot restart.
void restart_with_short_waits(const std::string& scenario) {
#if defined(__linux__) && !defined(__clang__)  // whose OpenMP has another name for it
  if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr) return;
  std::error_code unknown;
  if (std::filesystem::exists(scenario, unknown) && !std::filesystem::is_regular_file(scenario, unknown)) return;
  std::vector<std::string> arguments;
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  for (std::string argument; std::getline(file, argument, '\0');) arguments.push_back(argument);
  if (arguments.empty()) return;
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  // Looks, which take microseconds; sleeping at once costs a step up to half its time.
  setenv("GOMP_SPINCOUNT", "2000", 0);
  execv("/proc/self/exe", pointers.data());
#endif
}

}  // namespace

void add_threads_option(CLI::App& command, int& threads, const char* meaning) {
  command.add_option("--threads", threads, meaning)->check(CLI::Range(1, 1024));
}

void use_threads(int asked, std::size_t elements, const std::string& scenario) {
  const int threads = threads_for(asked, elements);
  if (threads > 1) restart_with_short_waits(scenario);
  omp_set_num_threads(threads);
}

}  // namespace plica
