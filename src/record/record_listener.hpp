// Who wants to see what a run leaves, while it leaves it: a report of it, a live view. The recorder knows no more of
// them than this.
#pragma once

#include "tissue/files/frame_file.hpp"

namespace plica {

class RecordListener {
 public:
  virtual ~RecordListener() = default;

  /// A frame has been written; also each of the frames of before when a run goes on. Called beside the computation, on
  /// the thread that writes, in the order of time.
  virtual void add_frame(const Frame& frame, double time_s) = 0;

  /// The run has ended and all its files are there.
  virtual void end() = 0;
};

}  // namespace plica
