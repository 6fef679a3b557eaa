#pragma once
/// The demo scene.

#include "assets/scene/scene.h"

namespace chiaro::builtin {

/// A twisted metal knot on a gadrooned dome on a plinth, amid eight fluted pillars on a round floor of 4 m. No surface enters another:
/// the floor is cut out under the plinth and the pillars, the plinth under the dome, with edges that meet exactly. About 50,000 vertices.
Scene ornament();

}  // namespace chiaro::builtin
