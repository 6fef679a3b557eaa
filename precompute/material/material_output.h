#pragma once
/// A fitted material for machines.

#include <string>

#include "precompute/material/material_study.h"

namespace chiaro {

/// A glTF 2.0 file of nothing but one material: CHIARO_materials_reflectance with the chosen model, the diffuse albedo as base colour. F0 is the
/// extension's `specularColor` where F90 is 1; else both are those of KHR_materials_specular. The second lobe of a fit with two is left out: give
/// a fit with one. Of a distribution alone: F0 = 1 and black.
std::string materialGltf(const MaterialStudy& study, const std::string& name, const std::string& generator);

/// What was fitted and how well; field names: docs/programs.md.
std::string materialJson(const MaterialStudy& study, const MaterialOptions& options, const std::string& file,
                         const std::string& version);

}  // namespace chiaro
