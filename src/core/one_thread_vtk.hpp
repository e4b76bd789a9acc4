// Keeps VTK on the calling thread; included by every file that uses VTK. With its own threads (TBB) a child process
// (child_process.hpp) that starts while one works may wait forever, and results would depend on the threads.
#pragma once

#include <cstdlib>

namespace plica {

/// Set before main(): VTK reads the variable once, at its first use. (vtkSMPTools.h is not valid C++20.)
inline const bool vtk_is_on_one_thread = ::setenv("VTK_SMP_BACKEND_IN_USE", "Sequential", 1) == 0;

}  // namespace plica
