#include "runtime/render/pixel_budget.h"

#include <algorithm>

namespace chiaro {
namespace {

constexpr double kFirstShare = 1.0 / 256.0;  // of a frame
constexpr unsigned kFewPixels = 256;         // take as long as starting to shade does

}  // namespace

void PixelBudget::measure(Frame& frame) {
  frame.pending = false;
  const unsigned shaded = std::min(frame.listed.read<std::uint32_t>().front(), frame.allowed);
  if (shaded < kFewPixels) return;
  secondsPerPixel_ = frame.timer.seconds() / shaded;
  measured_ = shaded;
}

unsigned PixelBudget::pixelsFor(double milliseconds, double pixelsOfFrame) {
  for (std::size_t k = 0; k < frames_.size(); ++k)  // the oldest first
    if (Frame& frame = frames_[(next_ + k) % frames_.size()]; frame.pending && frame.timer.ready()) measure(frame);
  const double first = std::max(kFirstShare * pixelsOfFrame, 2.0 * kFewPixels);
  const double most = std::max(first, 2.0 * measured_);
  const double fit = secondsPerPixel_ > 0.0 ? 1e-3 * milliseconds / secondsPerPixel_ : first;
  return frames_[next_].allowed = static_cast<unsigned>(std::min({fit, most, pixelsOfFrame}));
}

void PixelBudget::end(const gl::Buffer& shaded, std::size_t offset) {
  Frame& frame = frames_[next_];
  frame.timer.end();
  glCopyNamedBufferSubData(shaded.id(), frame.listed.id(), static_cast<GLintptr>(offset), 0, sizeof(std::uint32_t));
  frame.pending = true;
  next_ = (next_ + 1) % frames_.size();
}

}  // namespace chiaro
