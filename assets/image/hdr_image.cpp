#include <algorithm>
#include <cmath>

#include "assets/error.h"
#include "assets/file.h"
#include "assets/image/exr.h"
#include "assets/image/image.h"
#include "assets/image/radiance_hdr.h"

namespace chiaro {
namespace {

void requireRadiance(const ImageRgb& image, const std::string& where) {
  for (std::size_t i = 0; i < image.texels.size(); ++i) {
    const glm::vec3& t = image.texels[i];
    const bool ok = t.x >= 0.0f && t.y >= 0.0f && t.z >= 0.0f && std::isfinite(t.x) && std::isfinite(t.y) && std::isfinite(t.z);
    if (ok) continue;
    const auto width = static_cast<std::size_t>(image.width);
    throw inputError(where,
                     "texel (" + std::to_string(i % width) + ", " + std::to_string(i / width) + ") is negative or not finite",
                     "repair the image");
  }
}

ImageRgb radianceOf(const ExrImage& exr, const std::string& where) {
  ImageRgb image;
  image.width = exr.image.width;
  image.height = exr.image.height;
  image.texels.reserve(exr.image.texels.size());
  for (const auto& texel : exr.image.texels) image.texels.emplace_back(texel);
  requireRadiance(image, where);
  if (exr.rec709) return image;
  // Colours outside Rec.709 come out negative; they are cut to its border.
  for (auto& texel : image.texels) texel = glm::max(exr.rec709FromFile * texel, glm::vec3(0.0f));
  requireRadiance(image, where);
  return image;
}

}  // namespace

ImageRgb readHdrImage(const std::filesystem::path& path) {
  const std::string extension = lowerCaseExtension(path);
  const bool exr = extension == ".exr";
  if (!exr && extension != ".hdr")
    throw inputError(path.string(), "is neither .hdr nor .exr", "convert it to one of them");
  const auto bytes = readFile(path);
  return exr ? radianceOf(decodeExr(bytes, path.string()), path.string()) : decodeRadianceHdr(bytes, path.string());
}

ImageRgba readExr(const std::filesystem::path& path) { return decodeExr(readFile(path), path.string()).image; }

void writeExr(const std::filesystem::path& path, const ImageRgba& image) { writeFileAtomically(path, encodeExr(image)); }

}  // namespace chiaro
