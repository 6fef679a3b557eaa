#include <CLI/CLI.hpp>

#include "assets/program/command_line.h"
#include "assets/program/program.h"
#include "runtime/viewer/view_options.h"
#include "runtime/viewer/view_run.h"
#include "runtime/viewer/window_view.h"

namespace {

constexpr const char* kExamples = R"(Examples:
  chiaro-view baked.glb
      a window: left drag turns, right or middle drag moves, the wheel goes nearer, F frames the scene, arrow keys turn;
      drop an .hdr, .exr or baked .glb on it to load that
  chiaro-view baked.glb --environment overcast --environment sky.hdr
  chiaro-view baked.glb --headless --size 1920x1080 -o picture.png
  chiaro-view baked.glb --headless --camera eye=3,2,4,target=0,1,0,fov-deg=35 --roughness 0.2 -o picture.exr
  chiaro-view baked.glb --headless --orbit 30,10 --frames 50 --json timings.json
  chiaro-view baked.glb --window --frames 1 -o picture.png
      the same picture as --headless, by way of a window

Exit codes: 0 done, 1 failed, 2 wrong usage, 3 unreadable input, 4 unwritable output.)";

chiaro::ExitCode view(int argc, char** argv) {
  CLI::App app("Shows a baked scene, relit in real time.", "chiaro-view");
  app.footer(kExamples);
  app.set_version_flag("--version", "chiaro-view " CHIARO_VERSION);
  chiaro::ViewOptions options;
  chiaro::ViewOptionTexts texts;
  chiaro::declareViewOptions(app, options, texts);
  if (!chiaro::readCommandLine(app, argc, argv)) return chiaro::ExitCode::done;
  texts.framesGiven = app.count("--frames") > 0;
  chiaro::finishViewOptions(options, texts);
  switch (options.mode) {
    case chiaro::ViewMode::headless: chiaro::viewHeadless(options); break;
    case chiaro::ViewMode::window: chiaro::viewInWindow(options); break;
    case chiaro::ViewMode::interactive: chiaro::viewInteractive(options); break;
  }
  return chiaro::ExitCode::done;
}

}  // namespace

int main(int argc, char** argv) {
  return chiaro::runMain("chiaro-view", [&] { return view(argc, argv); });
}
