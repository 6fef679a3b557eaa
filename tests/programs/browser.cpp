#include "tests/programs/browser.h"

#include <unistd.h>

#include <cstdlib>
#include <stdexcept>

#include "assets/file.h"

namespace chiaro {
namespace {

// Errors are caught from before the page's first script on.
constexpr const char* kWatch =
    "<script>for (const kind of ['error', 'unhandledrejection']) addEventListener(kind, event => {"
    "document.documentElement.dataset.error = String(event.message || event.reason); });"
    "for (const name of ['error', 'warn']) console[name] = (...words) => { document.documentElement.dataset.error = words.join(' '); };</script>";

}  // namespace

std::optional<std::string> chromium() {
  const char* named = std::getenv("CHIARO_CHROMIUM");
  const std::string path = named != nullptr ? named : "/usr/bin/chromium";
  if (::access(path.c_str(), X_OK) != 0) return {};
  return path;
}

std::string documentAfter(const std::filesystem::path& page, const std::string& script) {
  const auto bytes = readFile(page);
  std::string html(bytes.begin(), bytes.end());
  const auto head = html.find("<head>"), end = html.rfind("</body>");
  if (head == std::string::npos || end == std::string::npos) throw std::runtime_error(page.string() + " is no page");
  html.insert(end, "<script>" + script + "</script>");
  html.insert(head + 6, kWatch);
  const auto folder = std::filesystem::absolute("browser_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  writeFileAtomically(folder / "page.html", html);
  const std::string command = "'" + chromium().value() + "' --headless --no-sandbox --disable-gpu --user-data-dir='" + (folder / "profile").string() +
                              "' --virtual-time-budget=5000 --dump-dom 'file://" + (folder / "page.html").string() + "' >'" + (folder / "dom").string() + "' 2>/dev/null";
  const int code = std::system(command.c_str());
  const auto dom = readFile(folder / "dom");
  std::filesystem::remove_all(folder);
  if (code != 0) throw std::runtime_error("chromium failed");
  return {dom.begin(), dom.end()};
}

}  // namespace chiaro
