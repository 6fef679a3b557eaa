#pragma once
/// The one way a bad input, a bad option or a full disk reaches the user.

#include <stdexcept>
#include <string>

namespace chiaro {

/// Process exit codes shared by every program (docs/programs.md).
enum class ExitCode : int {
  done = 0,
  failed = 1,
  usage = 2,
  unreadableInput = 3,
  unwritableOutput = 4,
  overTolerance = 5,
  interrupted = 130,
};

/// Printed as `program: where: what: remedy` on one line; `where` is a file (with :line where it is known) or an option.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, std::string where, std::string what, std::string remedy);

  ExitCode code() const { return code_; }
  const std::string& where() const { return where_; }

 private:
  ExitCode code_;
  std::string where_;
};

/// Unreadable or malformed input: exit 3.
Error inputError(std::string where, std::string what, std::string remedy);
/// Output that cannot be written: exit 4.
Error outputError(std::string where, std::string what, std::string remedy);
/// Wrong option or value: exit 2.
Error usageError(std::string where, std::string what, std::string remedy);

}  // namespace chiaro
