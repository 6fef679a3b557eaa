#pragma once
/// What the tests of this room share: a folder of their own, errors as text, and a small baked scene.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "assets/error.h"
#include "assets/scene/scene.h"
#include "assets/transfer/transfer.h"

namespace chiaro::test {

/// A fresh folder, removed with all that is in it.
class Folder {
 public:
  Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder();

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Writes without any of the library's own care. Returns the path.
std::filesystem::path put(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
std::filesystem::path put(const std::filesystem::path& path, const std::string& text);
std::vector<std::uint8_t> get(const std::filesystem::path& path);

/// The message of the Error that `action` throws, after checking that it is one line and carries `code`; "" with a test failure
/// when nothing is thrown. Any other exception is a failure of the test too.
template <class Action>
std::string errorOf(Action action, ExitCode code = ExitCode::unreadableInput) {
  try {
    action();
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_EQ(error.code(), code) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text;
  } catch (const std::exception& other) {
    ADD_FAILURE() << "not a chiaro::Error: " << other.what();
    return {};
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

/// True when `action` either succeeds or throws Error; anything else (another exception; a crash under a sanitizer) is a failure.
template <class Action>
bool failsCleanly(Action action) {
  try {
    action();
    return true;
  } catch (const Error&) {
    return true;
  } catch (const std::exception& other) {
    ADD_FAILURE() << "not a chiaro::Error: " << other.what();
    return false;
  }
}

/// A 3x2 PNG with six colours.
std::vector<std::uint8_t> tinyPng();
/// A JPEG of 1x1.
std::vector<std::uint8_t> tinyJpeg();

/// Two meshes, three primitives, every kind of attribute, material, camera and light, and a transfer of `terms` terms.
BakedScene sampleBake(int terms = 6);
/// The scene of sampleBake() with clustered transfer of 7 functions of 16, 12, 8 and 4 bits: clusters of 5, 0 and 2 terms. levels: as in a joint bake
/// (the fractions are part of the rows), with map scales; without, as in a clustered one, without map scales.
BakedScene clusteredBake(bool levels, int weightBits = 8);
/// The triangle of tinyBake() with two levels, map scales, four functions of 16, 12, 8 and 4 bits and two clusters, of one and no term.
BakedScene tinyClusteredBake();
/// One triangle, no image, one term, four directions: small enough for a test of every byte.
BakedScene tinyBake();

/// The evaluation pack's folder (CHIARO_DATA, else ../shared/data next to the checkout), if it is there.
std::optional<std::filesystem::path> evaluationPack();

}  // namespace chiaro::test
