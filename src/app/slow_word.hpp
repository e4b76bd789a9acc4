// A word on the terminal when nothing else would be seen for long.
#pragma once

namespace plica {

/// While one lives: after three seconds it says on standard error, once and where that is a terminal, that the embryo
/// is being built. The line goes with it. By SIGALRM and not a thread, since files are read in child processes.
class SlowWord {
 public:
  SlowWord();
  SlowWord(const SlowWord&) = delete;
  SlowWord& operator=(const SlowWord&) = delete;
  ~SlowWord();
};

}  // namespace plica
