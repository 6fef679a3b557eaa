#pragma once
// Runs a program of the build as a user would, and bakes the small scene that the tests of chiaro-view look at.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "assets/image/image.h"

namespace chiaro {

struct Finished {
  int code = -1;      // exit code, or 128 + the signal
  std::string out, err;
  int errorLines() const;
};

using Environ = std::vector<std::pair<std::string, std::string>>;  // an empty value removes the variable

// Runs CHIARO_BIN_DIR/program with these arguments and variables on top of our own, and waits.
Finished runProgram(const std::string& program, const std::vector<std::string>& arguments, const Environ& variables = {});

// A box on a floor with two cameras and two materials, baked coarsely; written to `path`.
void bakeSmallScene(const std::filesystem::path& path);

// The same scene under `count` lamps.
void bakeSceneOfLamps(const std::filesystem::path& path, int count);

// Largest difference of two pictures' channels in 1/255; a difference in size is 256.
int worstDifference(const Image8& a, const Image8& b);

}  // namespace chiaro
