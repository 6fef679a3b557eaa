#pragma once
/// Measured reflectance in the layout of the MERL database (Matusik et al., A Data-Driven Reflectance Model, 2003; ALGORITHMS 2.6).

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "precompute/material/half_difference.h"
#include "precompute/material/measured_reflectance.h"

namespace chiaro {

/// Three int32 (90, 90, 180), then a plane of float64 for red, green and blue, little-endian: index phiDiff + 180 (thetaDiff + 90 thetaHalf),
/// thetaHalf in steps of its root, phiDiff over [0, pi). Values times 1/1500, 1.15/1500, 1.66/1500 are reflectances; negative ones were not
/// measured.
class MerlTable {
 public:
  static constexpr std::size_t kThetaHalf = 90, kThetaDiff = 90, kPhiDiff = 180;
  static constexpr std::size_t kBins = kThetaHalf * kThetaDiff * kPhiDiff;
  static constexpr std::size_t kFileBytes = 12 + 3 * kBins * sizeof(double);

  /// 1/sr, by channel and bin; NaN where not measured. `values`: three planes of kBins.
  explicit MerlTable(std::vector<float> values) : values_(std::move(values)) {}

  static double thetaHalfOf(std::size_t bin);  ///< the bin's centre
  static double thetaDiffOf(std::size_t bin);
  static double phiDiffOf(std::size_t bin);

  lobe64::Vec3 bin(std::size_t thetaHalf, std::size_t thetaDiff, std::size_t phiDiff) const;
  /// Linear between bin centres in the three indices, over those of the eight that were measured; NaN where none was.
  lobe64::Vec3 at(const HalfDifference& angles) const;

  double measuredShare() const;  ///< of bins

 private:
  std::vector<float> values_;
};

/// `file`: the bytes of a .binary; `where` names it. Throws Error (unreadableInput) unless it has just the right length and header and every
/// value is finite, and where nothing was measured.
MerlTable readMerl(std::span<const std::uint8_t> file, const std::string& where);
/// A .binary, or one packed as .xz (any name that ends so). Throws Error (unreadableInput).
MerlTable readMerlFile(const std::filesystem::path& path);

/// The file of a table, for tools and tests: where `reflectance` is NaN, and below the surface, -1.
std::vector<std::uint8_t> merlFileOf(const ReflectanceFunction& reflectance);

}  // namespace chiaro
