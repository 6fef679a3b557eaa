#pragma once
#include <string>

namespace chiaro {

/// &, <, > and quotes as entities.
std::string htmlText(const std::string& text);

}  // namespace chiaro
