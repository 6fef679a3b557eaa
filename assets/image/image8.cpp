#include "assets/error.h"
#include "assets/file.h"
#include "assets/image/image.h"
#include "assets/image/jpeg_codec.h"
#include "assets/image/png_codec.h"

namespace chiaro {
namespace {

Error unknownFormat(const std::string& where) {
  return inputError(where, "is neither a PNG nor a JPEG image", "convert it to one of them");
}

}  // namespace

glm::ivec2 decodedSize(std::span<const std::uint8_t> bytes, const std::string& where) {
  if (isPng(bytes)) return pngSize(bytes, where);
  if (isJpeg(bytes)) return jpegSize(bytes, where);
  throw unknownFormat(where);
}

Image8 decodeImage8(std::span<const std::uint8_t> bytes, const std::string& where) {
  if (isPng(bytes)) return decodePng(bytes, where);
  if (isJpeg(bytes)) return decodeJpeg(bytes, where);
  throw unknownFormat(where);
}

Image8 readPng(const std::filesystem::path& path) {
  const auto bytes = readFile(path);
  if (!isPng(bytes)) throw inputError(path.string(), "is not a PNG image", "convert it to PNG");
  return decodePng(bytes, path.string());
}

void writePng(const std::filesystem::path& path, const Image8& image) { writeFileAtomically(path, encodePng(image)); }

}  // namespace chiaro
