#pragma once
/// Pictures in memory and in files.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace chiaro {

/// Linear Rec.709 radiance, row-major from the top left, `width*height` texels.
struct ImageRgb {
  int width = 0;
  int height = 0;
  std::vector<glm::vec3> texels;

  const glm::vec3& at(int x, int y) const { return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)]; }
  glm::vec3& at(int x, int y) { return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)]; }
};

/// Rec.709, of a linear colour.
inline double luminance(const glm::dvec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

/// The same with coverage (1 where an object is seen); colour is not premultiplied unless said.
struct ImageRgba {
  int width = 0;
  int height = 0;
  std::vector<glm::vec4> texels;

  const glm::vec4& at(int x, int y) const { return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)]; }
  glm::vec4& at(int x, int y) { return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)]; }
};

/// Display-encoded 8 bit RGBA, row-major from the top left.
struct Image8 {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> texels;  ///< 4 bytes a texel
};

/// Radiance .hdr (RGBE, old and new run-length coding) or OpenEXR .exr (any compression; R,G,B or Y; half, float).
/// Chromaticities in an EXR header are converted to Rec.709. Texels that are negative or not finite are an Error; so is a
/// size over 32768 a side. Throws Error (unreadableInput).
ImageRgb readHdrImage(const std::filesystem::path& path);

/// PNG or JPEG in memory. `where` names the source in an Error (unreadableInput).
Image8 decodeImage8(std::span<const std::uint8_t> bytes, const std::string& where);
/// Width and height without decoding the rest.
glm::ivec2 decodedSize(std::span<const std::uint8_t> bytes, const std::string& where);

Image8 readPng(const std::filesystem::path& path);
std::vector<std::uint8_t> encodePng(const Image8& image);
/// Atomic. Throws Error (unwritableOutput).
void writePng(const std::filesystem::path& path, const Image8& image);

/// Float 32 OpenEXR, ZIP. Atomic. Throws Error (unwritableOutput).
void writeExr(const std::filesystem::path& path, const ImageRgba& image);
/// RGBA as stored (alpha 1 where absent). Throws Error (unreadableInput).
ImageRgba readExr(const std::filesystem::path& path);

}  // namespace chiaro
