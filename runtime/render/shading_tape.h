#pragma once
/// What the pixels of a frame ask of visibility and light while they are shaded (shaders/stage/tape.glsl), so that others can answer better.

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace chiaro {

/// Numbers of shaders/stage/tape.glsl. What is asked:
enum class ShadingAsks {
  surface = 0,      ///< nothing: what the pixel's surface is, in kSurfaceNotes of them, see ShadedSurface
  share = 1,        ///< share of a lobe above the horizon that arrives; in `answer.x`
  fixedShare = 2,   ///< the same weighted by the cosine to the normal
  mean = 3,         ///< mean radiance of the environment under a lobe
  lobe = 4,         ///< mean light that arrives through a lobe of the reflection, in place of mean, share and the lights' own shares
  irradiance = 5,   ///< about the normal, which `axis` is
  rest = 6          ///< mean light through a fixed lobe, cosine-weighted, of the environment without its SG lights
};

/// std430 layout of TapedQuestion.
struct ShadingQuestion {
  glm::vec3 axis{0.0f};     ///< unit, world space
  float sharpness = 0.0f;
  glm::vec3 answer{0.0f};
  float code = 0.0f;        ///< recorded: a ShadingAsks; replayed: above 0 where `answer` takes the place of the renderer's own

  ShadingAsks asks() const { return static_cast<ShadingAsks>(static_cast<int>(code)); }
};
/// The first questions of a pixel.
inline constexpr std::size_t kSurfaceNotes = 4;
static_assert(sizeof(ShadingQuestion) == 32 && offsetof(ShadingQuestion, answer) == 16, "std430 says otherwise");

struct ShadingTape {
  int width = 0, height = 0;
  std::vector<std::uint32_t> starts;       ///< #pixels + 1, top row first: a pixel's questions are from its start to before the next one's
  std::vector<ShadingQuestion> questions;
};

/// What the renderer shaded, textures filtered as it does: world space, unit vectors, reference/surface.h has the same in its own words.
struct ShadedSurface {
  glm::vec3 position, ng, n, t;
  float alphaT, alphaB;
  glm::vec3 f0, diffuse;
  float f90;
  glm::vec3 emission;
};

/// From the kSurfaceNotes that a pixel begins with.
inline ShadedSurface shadedSurface(const ShadingQuestion* notes) {
  return {.position = notes[0].axis, .ng = notes[0].answer, .n = notes[1].axis, .t = notes[1].answer, .alphaT = notes[0].sharpness, .alphaB = notes[1].sharpness,
          .f0 = notes[2].axis, .diffuse = notes[2].answer, .f90 = notes[2].sharpness, .emission = notes[3].axis};
}

}  // namespace chiaro
