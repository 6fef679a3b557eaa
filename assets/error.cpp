#include "assets/error.h"

#include <algorithm>
#include <utility>

namespace chiaro {
namespace {

/// One line, whatever a library's message holds.
std::string oneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::replace(text.begin(), text.end(), '\r', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

}  // namespace

Error::Error(ExitCode code, std::string where, std::string what, std::string remedy)
    : std::runtime_error(oneLine(where + ": " + what + (remedy.empty() ? "" : ": " + remedy))),
      code_(code),
      where_(std::move(where)) {}

Error inputError(std::string where, std::string what, std::string remedy) {
  return {ExitCode::unreadableInput, std::move(where), std::move(what), std::move(remedy)};
}

Error outputError(std::string where, std::string what, std::string remedy) {
  return {ExitCode::unwritableOutput, std::move(where), std::move(what), std::move(remedy)};
}

Error usageError(std::string where, std::string what, std::string remedy) {
  return {ExitCode::usage, std::move(where), std::move(what), std::move(remedy)};
}

}  // namespace chiaro
