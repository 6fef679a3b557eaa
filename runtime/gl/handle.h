#pragma once
/// A GL object name that is deleted once: the base of every wrapper in this folder. Move-only; 0 means "none".

#include <epoxy/gl.h>

#include <utility>

namespace chiaro::gl {

/// `Deleter` has `static void destroy(GLuint)`. The context that made the object must be current when it goes.
template <class Deleter>
class Handle {
 public:
  Handle() = default;
  explicit Handle(GLuint id) : id_(id) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    if (this != &other) {
      reset();
      id_ = std::exchange(other.id_, 0);
    }
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { reset(); }

  GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }
  void reset() {
    if (id_ != 0) Deleter::destroy(id_);
    id_ = 0;
  }

 private:
  GLuint id_ = 0;
};

}  // namespace chiaro::gl
