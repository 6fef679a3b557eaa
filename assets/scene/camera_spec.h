#pragma once
/// A camera as a person names it on a command line: one text, so that two programs draw the same view of the same file.

#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "assets/scene/scene.h"

namespace chiaro {

struct CameraSpec {
  enum class Kind { automatic, index, name, lookAt };
  Kind kind = Kind::automatic;
  int index = 0;                    ///< of Scene::cameras (index)
  std::string name;                 ///< of a camera in the scene (name)
  glm::vec3 eye{0.0f};              ///< metres (lookAt)
  glm::vec3 target{0.0f};
  float verticalFov = 0.698131701f; ///< radians; 40 degrees where the text says nothing
};

/// `auto` | INDEX | NAME | `name=NAME` | `eye=X,Y,Z,target=X,Y,Z[,fov-deg=D]` (metres; 0 < D < 180, 40 when left out).
/// `name=` reaches a camera whose name reads like one of the other forms. Throws Error (usage), whose `where` is `option`.
CameraSpec parseCameraSpec(const std::string& text, const std::string& option = "--camera");

/// The text that parses to this camera (perspective, looking at `target`), so that a view found by hand can be drawn again.
std::string lookAtSpec(glm::vec3 eye, glm::vec3 target, float verticalFov);

/// auto is defaultCamera(). A camera that looks along a line (not one of the file) gets its near and far from the scene's
/// bounds. Throws Error (usage) for an index or a name the scene does not have, listing those it has.
Camera resolveCamera(const CameraSpec& spec, const Scene& scene, float aspect, const std::string& option = "--camera");

/// Two angles in degrees, "30,-10". Returned in radians (azimuth, elevation). Throws Error (usage).
glm::vec2 parseOrbit(const std::string& text, const std::string& option = "--orbit");

/// The point on the camera's axis that it is taken to look at: the one nearest to the middle of the bounds, or, where that
/// lies behind the camera, one at a bounds' radius ahead. Orbiting turns about it.
glm::vec3 orbitTarget(const Camera& camera, const Bounds& bounds);

/// The camera carried around `target`: first by `azimuth` about +Y (counter-clockwise seen from above), then up by
/// `elevation` (radians), stopping 1 degree short of the poles unless it already was nearer. Roll and distance stay. Zero
/// angles return the camera unchanged.
Camera orbited(const Camera& camera, glm::vec3 target, float azimuth, float elevation);

/// Near and far planes about the bounds as the camera stands, as lookAt() sets them.
void fitDepthRange(Camera& camera, const Bounds& bounds);

}  // namespace chiaro
