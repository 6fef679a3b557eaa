#pragma once
/// GPU time of a stretch of commands.

#include <epoxy/gl.h>

#include <cstdint>

#include "runtime/gl/handle.h"

namespace chiaro::gl {

struct QueryDeleter {
  static void destroy(GLuint id) { glDeleteQueries(1, &id); }
};

/// Two time stamps, so that timers may nest and overlap (GL_TIME_ELAPSED may not).
class TimerQuery {
 public:
  TimerQuery() = default;
  static TimerQuery create() {
    GLuint ids[2] = {0, 0};
    glCreateQueries(GL_TIMESTAMP, 2, ids);
    TimerQuery query;
    query.begin_ = Handle<QueryDeleter>(ids[0]);
    query.end_ = Handle<QueryDeleter>(ids[1]);
    return query;
  }
  void begin() const { glQueryCounter(begin_.id(), GL_TIMESTAMP); }
  void end() const { glQueryCounter(end_.id(), GL_TIMESTAMP); }
  /// Both stamps are known: seconds() will not wait.
  bool ready() const {
    GLint available = GL_FALSE;
    glGetQueryObjectiv(end_.id(), GL_QUERY_RESULT_AVAILABLE, &available);
    return available == GL_TRUE;
  }
  /// Seconds between begin and end. Waits for the GPU.
  double seconds() const {
    GLuint64 from = 0, to = 0;
    glGetQueryObjectui64v(begin_.id(), GL_QUERY_RESULT, &from);
    glGetQueryObjectui64v(end_.id(), GL_QUERY_RESULT, &to);
    return static_cast<double>(to - from) * 1e-9;
  }

 private:
  Handle<QueryDeleter> begin_, end_;
};

}  // namespace chiaro::gl
