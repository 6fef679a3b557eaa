#pragma once
/// Files that say what a material reflects, whatever their form.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "precompute/material/measured_reflectance.h"
#include "precompute/material/merl_file.h"
#include "precompute/material/ndf_table.h"
#include "precompute/material/ngan_model.h"

namespace chiaro {

enum class MaterialForm { merl, sgd, abc, ngan, ndf };
const char* formName(MaterialForm form);

struct MaterialData {
  std::string name;  ///< the row's, or the file's without its endings
  MaterialForm form = MaterialForm::merl;
  ReflectanceFunction reflectance;        ///< empty for a distribution alone
  std::optional<NdfTable> ndf;    ///< then this
  std::optional<NganModel> ngan;  ///< what `reflectance` is made of, in a table of Ngan's
};

/// Every material of a file: one of a .binary, .binary.xz or a distribution, all rows of a table. Tables are known by the names in their first line:
///   material,...,rhoD_r,...   shifted gamma (Bagher 2012)    material,kD_r,...    ABC (Low 2012)    material,fit,error,lobes    Ngan 2005, named MATERIAL/FIT
/// Throws Error (unreadableInput), with the line where there is one.
std::vector<MaterialData> readMaterials(const std::filesystem::path& path);

/// The one that `row` names, or the only one. Throws Error (usage) where there is no such row, or several and none is named.
MaterialData readMaterial(const std::filesystem::path& path, const std::string& row);

}  // namespace chiaro
