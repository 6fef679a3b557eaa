#pragma once
/// The kernels of shaders/parity on this machine's OpenGL driver.

#include <vector>

#include "runtime/gl/program.h"
#include "shaders/parity/parity.h"

namespace chiaro::parity {

/// Runs one kernel over all its inputs: one invocation a sample, inputs and outputs in storage buffers. outputCount values per sample. reader: gl::readEmbeddedShader, or
/// one that changes what it reads. Needs a current context. Throws Error.
std::vector<float> runGlsl(const Case& c, const gl::ShaderReader& reader);

}  // namespace chiaro::parity
