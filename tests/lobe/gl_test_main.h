#pragma once
/// For test programs that need OpenGL: link gl_test_main.cpp, which makes one headless context or exits with 77 (skipped).

#include "runtime/gl/context.h"

/// Current on the main thread while tests run.
chiaro::gl::HeadlessContext& testContext();
