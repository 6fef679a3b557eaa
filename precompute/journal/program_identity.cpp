#include "precompute/journal/program_identity.h"

#include <filesystem>

#include "assets/file.h"
#include "assets/transfer/transfer_format.h"
#include "precompute/compression/blas_name.h"

namespace chiaro {

std::string programIdentity(const std::string& nameAndVersion) {
  std::string text = nameAndVersion + ", " + blasName();
  std::error_code error;
  if (std::filesystem::exists("/proc/self/exe", error)) text += " " + checksumOf(readFile("/proc/self/exe"));
  return text;
}

}  // namespace chiaro
