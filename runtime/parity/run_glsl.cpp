#include "runtime/parity/run_glsl.h"

#include "runtime/gl/buffer.h"

namespace chiaro::parity {

std::vector<float> runGlsl(const Case& c, const gl::ShaderReader& reader) {
  const std::string main = "#include \"shaders/parity/kernels.glsl\"\n"
      "layout(local_size_x = 64) in;\n"
      "layout(std430, binding = 0) readonly buffer Inputs { float inputs[]; };\n"
      "layout(std430, binding = 1) writeonly buffer Outputs { float outputs[]; };\n"
      "uniform uint sampleCount;\n"
      "void main() {\n"
      "  uint s = gl_GlobalInvocationID.x;\n"
      "  if (s >= sampleCount) return;\n"
      "  KernelInput x;\n"
      "  for (int i = 0; i < 12; ++i) x.v[i] = i < INPUTS ? inputs[s * INPUTS + i] : 0.0;\n"
      "  float y[25];\n"
      "  KERNEL_UNDER_TEST(x, y);\n"
      "  for (int i = 0; i < OUTPUTS; ++i) outputs[s * OUTPUTS + i] = y[i];\n"
      "}\n";
  const std::vector<std::string> defines{"KERNEL_UNDER_TEST kernel_" + c.name, "INPUTS " + std::to_string(c.inputCount),
                                         "OUTPUTS " + std::to_string(c.outputCount)};
  const gl::Program program = gl::Program::link({{GL_COMPUTE_SHADER, gl::resolveShaderText(c.name + ".comp", main, reader, defines)}});
  const gl::Buffer inputs(c.inputs);
  const gl::Buffer outputs(c.sampleCount() * static_cast<std::size_t>(c.outputCount) * sizeof(float));
  inputs.bindBase(GL_SHADER_STORAGE_BUFFER, 0);
  outputs.bindBase(GL_SHADER_STORAGE_BUFFER, 1);
  program.set("sampleCount", static_cast<unsigned>(c.sampleCount()));
  program.use();
  glDispatchCompute(static_cast<GLuint>((c.sampleCount() + 63) / 64), 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  return outputs.read<float>();
}

}  // namespace chiaro::parity
