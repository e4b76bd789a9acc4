// Number of threads of a run.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>

namespace plica {

/// Add the option --threads.
void add_threads_option(CLI::App& command, int& threads, const char* meaning = "number of threads");

/// Set the number of threads: `asked`, else OMP_NUM_THREADS, else as many as the mesh can keep busy. Results do not
/// depend on it.
///
/// May restart the program, so call it before anything is printed or written. GCC's OpenMP lets idle threads spin for
/// milliseconds before they sleep; on a busy machine threads with work wait for these (251 s instead of 19 s,
/// docs/developers/performance-notebook.md). The spin time is read from the environment before main(). `scenario`: file
/// that has been read, or name; no restart for a pipe, which cannot be read twice.
void use_threads(int asked, std::size_t elements, const std::string& scenario);

}  // namespace plica
