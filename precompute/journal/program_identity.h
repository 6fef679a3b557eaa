#pragma once
/// Which build of which program made something.

#include <string>

namespace chiaro {

/// nameAndVersion, the linear algebra in use, and the program's very bytes where the system shows them: what one build left is no part of another's work.
std::string programIdentity(const std::string& nameAndVersion);

}  // namespace chiaro
