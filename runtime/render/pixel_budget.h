#pragma once
/// How many pixels may be shaded in a given GPU time, from how long those of earlier frames took. Never waits for a frame in flight.

#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime/gl/buffer.h"
#include "runtime/gl/query.h"

namespace chiaro {

class PixelBudget {
 public:
  /// For a frame of so many pixels. Few at first, and at most twice as many with each measurement: what a scattered list costs, nothing before it tells.
  unsigned pixelsFor(double milliseconds, double pixelsOfFrame);
  /// Before the shading and after it; `shaded` holds how many were listed at this offset.
  void begin() const { frames_[next_].timer.begin(); }
  void end(const gl::Buffer& shaded, std::size_t offset);

 private:
  struct Frame {
    gl::TimerQuery timer = gl::TimerQuery::create();
    gl::Buffer listed{sizeof(std::uint32_t)};
    unsigned allowed = 0;
    bool pending = false;
  };
  void measure(Frame& frame);

  std::array<Frame, 4> frames_;  // more than drivers keep in flight
  std::size_t next_ = 0;
  unsigned measured_ = 0;  // pixels of the last measurement
  double secondsPerPixel_ = 0.0;
};

}  // namespace chiaro
