// A window and no window give the same picture. Needs Xvfb, which it starts itself; without one it is skipped.

#include <epoxy/gl.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "assets/builtin/environment.h"
#include "assets/transfer/transfer.h"
#include "runtime/render/renderer.h"
#include "runtime/viewer/window.h"
#include "tests/programs/view_support.h"

extern char** environ;

namespace chiaro {
namespace {

/// An X server of our own, on a display number of its choice, for as long as the test runs.
class VirtualScreen {
 public:
  static std::optional<pid_t> start() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), 0) != 0) return std::nullopt;
    const std::string descriptor = std::to_string(ends[1]);
    std::array<const char*, 9> words{"Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", "1280x1024x24", "-nolisten", "tcp", nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addclose(&actions, ends[0]);
    posix_spawn_file_actions_addopen(&actions, 2, "xvfb.log", O_WRONLY | O_CREAT | O_TRUNC, 0600);
    pid_t server = 0;
    const int status = posix_spawnp(&server, "Xvfb", &actions, nullptr, const_cast<char* const*>(words.data()), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    // The server writes its number when it is ready; a server that could not start closes the pipe instead.
    std::string number;
    for (char c = 0; status == 0 && ::read(ends[0], &c, 1) == 1 && c != '\n';) number += c;
    ::close(ends[0]);
    if (number.empty()) {
      if (status == 0) stop(server);
      return std::nullopt;
    }
    ::setenv("DISPLAY", (":" + number).c_str(), 1);
    ::unsetenv("WAYLAND_DISPLAY");
    return server;
  }
  static void stop(pid_t server) {
    ::kill(server, SIGTERM);
    ::waitpid(server, nullptr, 0);
  }
};

const std::string kScene = "small.glb";

class ViewWindow : public testing::Test {
 protected:
  static void SetUpTestSuite() { bakeSmallScene(kScene); }
};

TEST_F(ViewWindow, DrawsWhatHeadlessDraws) {
  const std::vector<std::vector<std::string>> cases{
      {"--size", "320x200", "-e", "sunny"},
      {"--size", "157x93", "-e", "windows", "--supersample", "2", "--orbit", "40,10", "--rotate-environment-deg", "75"},
      {"--size", "320x200", "-e", "overcast", "--debug-view", "normal"}};
  for (const auto& options : cases) {
    SCOPED_TRACE(testing::PrintToString(options));
    for (const char* mode : {"--headless", "--window"}) {
      std::vector<std::string> arguments{kScene, mode, "--frames", "3", "-o", std::string(mode + 2) + ".png"};
      arguments.insert(arguments.end(), options.begin(), options.end());
      const Finished run = runProgram("chiaro-view", arguments);
      ASSERT_EQ(run.code, 0) << run.err;
    }
    // The same driver behind both contexts gives the same bits; two drivers (a GPU's and a software one) may round apart.
    EXPECT_LE(worstDifference(readPng("headless.png"), readPng("window.png")), 1);
  }
}

TEST_F(ViewWindow, ShowsTheFrameItSaves) {
  const glm::ivec2 size(200, 120);
  Window window(size, "test");
  ASSERT_EQ(window.framebufferSize(), size);
  const BakedScene baked = readBakedScene(kScene);
  Renderer renderer(baked);
  renderer.setEnvironment(prepareEnvironment(loadEnvironment("windows")));
  RenderSettings settings;
  settings.width = size.x;
  settings.height = size.y;
  renderer.render(baked.scene.cameras[0], settings);
  renderer.present(size.x, size.y);

  Image8 shown{size.x, size.y, std::vector<std::uint8_t>(static_cast<std::size_t>(4 * size.x * size.y))};
  std::vector<std::uint8_t> rows(shown.texels.size());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, size.x, size.y, GL_RGBA, GL_UNSIGNED_BYTE, rows.data());
  const auto stride = static_cast<std::ptrdiff_t>(4 * size.x);
  for (int y = 0; y < size.y; ++y)
    std::copy_n(rows.begin() + stride * (size.y - 1 - y), stride, shown.texels.begin() + stride * y);
  for (std::size_t i = 3; i < shown.texels.size(); i += 4) shown.texels[i] = 255;  // a window's alpha means nothing
  EXPECT_LE(worstDifference(shown, renderer.readDisplay()), 1);
  window.debugLog().requireClean("the test");
}

}  // namespace
}  // namespace chiaro

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const auto server = chiaro::VirtualScreen::start();
  if (!server) {
    std::printf("skipped: Xvfb is not installed or does not start\n");
    return 77;
  }
  const int result = RUN_ALL_TESTS();
  chiaro::VirtualScreen::stop(*server);
  return result;
}
