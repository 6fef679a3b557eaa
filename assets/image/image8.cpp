// PNG and JPEG through stb. Its functions are made static, so that they cannot meet those of another library in one program.
#include "assets/image/image.h"

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#define STBI_MAX_DIMENSIONS 32768
#include <stb/stb_image.h>
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "assets/error.h"
#include "assets/file.h"
#include "assets/image/image_limits.h"

namespace chiaro {
namespace {

bool isPng(std::span<const std::uint8_t> bytes) {
  static constexpr std::uint8_t kSignature[] = {0x89, 'P', 'N', 'G', 0x0D, 0x0A, 0x1A, 0x0A};
  return bytes.size() >= sizeof kSignature && std::equal(std::begin(kSignature), std::end(kSignature), bytes.begin());
}

bool isJpeg(std::span<const std::uint8_t> bytes) { return bytes.size() >= 3 && bytes[0] == 0xFF && bytes[1] == 0xD8 && bytes[2] == 0xFF; }

/// stb paints what is missing of a JPEG grey. Inside a scan 0xFF is always escaped, so the end marker cannot occur by chance.
bool hasJpegEnd(std::span<const std::uint8_t> bytes) {
  static constexpr std::uint8_t kEnd[] = {0xFF, 0xD9};
  return std::search(bytes.begin(), bytes.end(), std::begin(kEnd), std::end(kEnd)) != bytes.end();
}

/// PNG sizes come first in the file; stb refuses large ones with a message of its own.
void requirePngSize(std::span<const std::uint8_t> bytes, const std::string& where) {
  if (bytes.size() < 24) throw inputError(where, "the PNG image is truncated", "save it again");
  const auto word = [&](std::size_t at) {
    return std::int64_t{bytes[at]} << 24 | std::int64_t{bytes[at + 1]} << 16 | std::int64_t{bytes[at + 2]} << 8 | std::int64_t{bytes[at + 3]};
  };
  requireImageSize(word(16), word(20), where);
}

int lengthOf(std::span<const std::uint8_t> bytes, const std::string& where) {
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) throw inputError(where, "is larger than 2 GiB", "use a smaller image");
  return static_cast<int>(bytes.size());
}

}  // namespace

glm::ivec2 decodedSize(std::span<const std::uint8_t> bytes, const std::string& where) {
  if (!isPng(bytes) && !isJpeg(bytes)) throw inputError(where, "is neither a PNG nor a JPEG image", "convert it to one of them");
  if (isPng(bytes)) requirePngSize(bytes, where);
  int width = 0, height = 0, channels = 0;
  if (stbi_info_from_memory(bytes.data(), lengthOf(bytes, where), &width, &height, &channels) == 0)
    throw inputError(where, std::string("its image header cannot be read (") + stbi_failure_reason() + ")", "save it again");
  requireImageSize(width, height, where);
  return {width, height};
}

Image8 decodeImage8(std::span<const std::uint8_t> bytes, const std::string& where) {
  decodedSize(bytes, where);
  if (isJpeg(bytes) && !hasJpegEnd(bytes)) throw inputError(where, "the JPEG image is truncated", "save it again");
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, void (*)(void*)> decoded(
      stbi_load_from_memory(bytes.data(), lengthOf(bytes, where), &width, &height, &channels, 4), stbi_image_free);
  if (!decoded) throw inputError(where, std::string("the image cannot be decoded (") + stbi_failure_reason() + ")", "save it again");
  Image8 image;
  image.width = width;
  image.height = height;
  image.texels.assign(decoded.get(), decoded.get() + 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  return image;
}

Image8 readPng(const std::filesystem::path& path) {
  const auto bytes = readFile(path);
  if (!isPng(bytes)) throw inputError(path.string(), "is not a PNG image", "convert it to PNG");
  return decodeImage8(bytes, path.string());
}

std::vector<std::uint8_t> encodePng(const Image8& image) {
  const auto expected = 4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.width < 1 || image.height < 1 || image.texels.size() != expected)
    throw Error(ExitCode::failed, "PNG", "the image's size and texels do not fit each other", "");
  std::vector<std::uint8_t> bytes;
  const auto append = [](void* target, void* data, int size) {
    const auto* first = static_cast<const std::uint8_t*>(data);
    auto& out = *static_cast<std::vector<std::uint8_t>*>(target);
    out.insert(out.end(), first, first + size);
  };
  if (stbi_write_png_to_func(append, &bytes, image.width, image.height, 4, image.texels.data(), 4 * image.width) == 0)
    throw Error(ExitCode::failed, "PNG", "the image cannot be encoded", "");
  return bytes;
}

void writePng(const std::filesystem::path& path, const Image8& image) { writeFileAtomically(path, encodePng(image)); }

}  // namespace chiaro
