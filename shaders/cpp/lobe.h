#pragma once
/// The maths of shaders/lobe as C++: the same text that the GL driver compiles, as float (what the GPU does) in chiaro::lobe32 and as
/// double (the oracle) in chiaro::lobe64. Formulas, ranges and errors are documented in the .glsl files. Pure functions; none throws.

#include <glm/glm.hpp>
#include <limits>

#include "shaders/cpp/dialect_begin.h"

namespace chiaro::lobe32 {
using Real = float;
#include "shaders/cpp/dialect.h"
#include "shaders/cpp/lobe_files.h"
}  // namespace chiaro::lobe32

namespace chiaro::lobe64 {
using Real = double;
#include "shaders/cpp/dialect.h"
#include "shaders/cpp/lobe_files.h"
}  // namespace chiaro::lobe64

#include "shaders/cpp/dialect_end.h"
