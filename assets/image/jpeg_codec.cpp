#include "assets/image/jpeg_codec.h"

#include <turbojpeg.h>

#include <memory>
#include <new>
#include <string_view>
#include <type_traits>

#include "assets/error.h"
#include "assets/image/image_limits.h"

namespace chiaro {
namespace {

class Decoder {
 public:
  Decoder(std::span<const std::uint8_t> bytes, const std::string& where)
      : handle_(tjInitDecompress(), &tjDestroy), bytes_(bytes), where_(where) {
    if (!handle_) throw std::bad_alloc();
  }

  glm::ivec2 size() {
    glm::ivec2 size(0);
    int subsampling = 0, colorSpace = 0;
    require(tjDecompressHeader3(handle_.get(), bytes_.data(), static_cast<unsigned long>(bytes_.size()), &size.x, &size.y,
                                &subsampling, &colorSpace));
    requireImageSize(size.x, size.y, where_);
    return size;
  }

  Image8 decode() {
    const glm::ivec2 extent = size();
    Image8 image;
    image.width = extent.x;
    image.height = extent.y;
    image.texels.resize(4 * static_cast<std::size_t>(extent.x) * static_cast<std::size_t>(extent.y));
    // A small file may ask for thousands of scans over a huge picture: the library's limit ends that.
    require(tjDecompress2(handle_.get(), bytes_.data(), static_cast<unsigned long>(bytes_.size()), image.texels.data(), extent.x,
                          0, extent.y, TJPF_RGBA, TJFLAG_LIMITSCANS | TJFLAG_ACCURATEDCT));
    return image;
  }

 private:
  /// Warnings tell of stray bytes, which harm nothing, and of missing ones, which do.
  void require(int result) {
    if (result == 0) return;
    const std::string_view text = tjGetErrorStr2(handle_.get());
    const bool harmless =
        tjGetErrorCode(handle_.get()) == TJERR_WARNING && text.find("extraneous bytes") != std::string_view::npos;
    if (!harmless) throw inputError(where_, "the JPEG image cannot be decoded (" + std::string(text) + ")", "save it again");
  }

  std::unique_ptr<std::remove_pointer_t<tjhandle>, decltype(&tjDestroy)> handle_;
  std::span<const std::uint8_t> bytes_;
  const std::string& where_;
};

}  // namespace

bool isJpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xFF && bytes[1] == 0xD8 && bytes[2] == 0xFF;
}

glm::ivec2 jpegSize(std::span<const std::uint8_t> bytes, const std::string& where) { return Decoder(bytes, where).size(); }

Image8 decodeJpeg(std::span<const std::uint8_t> bytes, const std::string& where) { return Decoder(bytes, where).decode(); }

}  // namespace chiaro
