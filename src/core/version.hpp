// Version of this build.
#pragma once

namespace plica {

const char* version();   // as in CMakeLists.txt
const char* commit();    // git commit at configure time, or "unknown"
const char* compiler();  // compiler, its version and the build type

}  // namespace plica
