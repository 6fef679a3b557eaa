#include "assets/program/program.h"

#include <cstdio>
#include <exception>
#include <new>

namespace chiaro {
namespace {

int fail(const std::string& program, const char* message, ExitCode code) {
  std::fflush(stdout);
  std::fprintf(stderr, "%s: %s\n", program.c_str(), message);
  return static_cast<int>(code);
}

}  // namespace

int runMain(const std::string& program, const std::function<ExitCode()>& body) {
  try {
    return static_cast<int>(body());
  } catch (const Error& error) {
    return fail(program, error.what(), error.code());
  } catch (const std::bad_alloc&) {
    return fail(program, "memory: there is not enough: close other programs or use a smaller input", ExitCode::failed);
  } catch (const std::exception& error) {
    return fail(program, (std::string("unexpected: ") + error.what()).c_str(), ExitCode::failed);
  }
}

}  // namespace chiaro
