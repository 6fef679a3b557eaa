#pragma once
/// chiaro-view with a window.

#include "runtime/viewer/view_options.h"

namespace chiaro {

/// Until the window is closed: orbit camera, panel, dropped files. Throws Error for what keeps it from starting; later errors
/// are shown in the panel.
void viewInteractive(const ViewOptions& options);

/// The whole of --window: what viewHeadless() does, in a window that shows each frame under the panel.
void viewInWindow(const ViewOptions& options);

}  // namespace chiaro
