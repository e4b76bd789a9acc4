// Included by every file that uses VTK: it stays on the thread that calls it. Else it would start threads of its own
// (TBB), which a child process (child_process.hpp) that starts in the midst of one's doings may wait for without end;
// and what it computes would depend on them.
#pragma once

#include <cstdlib>

namespace plica {

/// Before main(): VTK looks once, when it is first at work. (Its vtkSMPTools.h, which can say so too, is no C++20.)
inline const bool vtk_is_on_one_thread = ::setenv("VTK_SMP_BACKEND_IN_USE", "Sequential", 1) == 0;

}  // namespace plica
