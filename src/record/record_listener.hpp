// Observer of recorded output, for example a report or a live view.
#pragma once

#include "tissue/files/frame_file.hpp"

namespace plica {

class RecordListener {
 public:
  virtual ~RecordListener() = default;

  /// Called for each written snapshot in order of time, on the writing thread; on resumption also for earlier ones.
  virtual void add_frame(const Frame& frame, double time_s) = 0;

  /// Called at the end of the run, when all files exist.
  virtual void end() = 0;
};

}  // namespace plica
