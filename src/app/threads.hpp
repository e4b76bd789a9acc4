// How many threads a run is given.
#pragma once

#include <cstddef>
#include <string>

namespace plica {

/// From now on as many threads as asked; else as OMP_NUM_THREADS says; else as many as the mesh can keep busy. Results
/// do not depend on it.
///
/// May begin the program anew, to the same end: to be called before anything is printed or written. GCC's OpenMP has
/// threads look for work for milliseconds before they sleep. Where other programs want the cores, those that have work
/// wait for them: a run took 251 s instead of 19 (docs/developers/performance-notebook.md). How long they look is read
/// from the environment before main() begins. `scenario` is the file that has been read, or a name: a pipe cannot be
/// read twice, so then the program goes on as it is.
void use_threads(int asked, std::size_t elements, const std::string& scenario);

}  // namespace plica
