#pragma once
/// The maths of shaders/lobe as C++: the same text that the GL driver compiles, as float (what the GPU does) in chiaro::lobe32 and as
/// double (the oracle) in chiaro::lobe64. Formulas, ranges and errors are documented in the .glsl files. Pure functions; none throws.

#include <glm/glm.hpp>
#include <limits>

#define CHIARO_CPP 1
#define FN inline
#define CONST inline const
#define IN(T) const T&
#define OUT(T) T&
#define INOUT(T) T&
#define OUT_ARRAY(T, name, size) T (&name)[size]

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

#undef CHIARO_CPP
#undef FN
#undef CONST
#undef IN
#undef OUT
#undef INOUT
#undef OUT_ARRAY
