#pragma once
/// What the report draws: curves over one quantity.

#include <string>
#include <vector>

namespace chiaro {

struct Curve {
  std::string name;
  std::vector<double> x, y;
  bool dashed = false;  ///< what ours is compared with
  int colour = -1;      ///< of the list; -1: the curve's own place
  bool joined = true;   ///< a line through the points
  bool dotted = true;   ///< a dot at each
};

struct Figure {
  std::string id;  ///< for the JSON and CSV
  std::string title;
  std::string xLabel, yLabel;
  std::string note;  ///< under the figure
  bool logX = false, logY = true;
  std::vector<Curve> curves;
};

/// Inline SVG, 640 x 400, with axes, a legend and a title element for each curve. Points that are not finite, or not positive on a logarithmic
/// axis, are left out, and so is what lies more than eight decades below the top. Colours follow the page's light or dark scheme.
std::string figureSvg(const Figure& figure);

/// The same as a file of its own, with its title above and its note below.
std::string figureFile(const Figure& figure);

}  // namespace chiaro
