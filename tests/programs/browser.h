#pragma once
// A page of a report in headless Chromium.

#include <filesystem>
#include <optional>
#include <string>

namespace chiaro {

// Chromium, from CHIARO_CHROMIUM or where Debian puts it; nothing where it is absent.
std::optional<std::string> chromium();

// What is in the document after the page's scripts and then `script` have run: its HTML. A script's error, or one of the page's before it, becomes the attribute
// data-error of the root element.
std::string documentAfter(const std::filesystem::path& page, const std::string& script);

}  // namespace chiaro
