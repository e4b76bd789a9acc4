// Notice on the terminal while a long preparation prints nothing else.
#pragma once

namespace plica {

/// Notice "building the embryo ..." on standard error, printed once after 3 s if that is a terminal. The destructor
/// erases the line. Uses SIGALRM instead of a thread, since files are read in child processes.
class DelayedNotice {
 public:
  DelayedNotice();
  DelayedNotice(const DelayedNotice&) = delete;
  DelayedNotice& operator=(const DelayedNotice&) = delete;
  ~DelayedNotice();
};

}  // namespace plica
