#include "examples.hpp"

#include <map>

namespace taut::app {
namespace {

/// Every line has at most 80 columns and can be typed as it is, but for the files.
const std::map<std::string, std::string>& examples() {
  static const std::map<std::string, std::string> all = {
      {"path",
       "  taut path 'x^2+y^2+4z^2=1' --from 1,0,0 --to 0,0,0.5\n"
       "  taut path 'x^2+y^2+4z^2=1' --from 1,0,0 --to -1,0,0 --all --json\n"
       "  taut path scan.ply --from @120 --to @2411 --out page.html\n"
       "  taut path 'x^2+y^2+z^2=1' --pairs pairs.csv --header --unique\n"},
      {"field",
       "  taut field 'x^4+y^4+z^4=1' --from 1,0,0 --out field.ply\n"
       "  taut field 'x^2+y^2+4z^2=1' --from 1,0,0 --at points.csv --directions\n"},
      {"exp", "  taut exp 'x^2+y^2+4z^2=1' --from 1,0,0 --dir 0,1,1 --length 2\n"},
      {"log", "  taut log 'x^2+y^2+4z^2=1' --from 1,0,0 --to 0,0,0.5\n"},
      {"transport", "  taut transport 'x^2+y^2+z^2=1' --from 1,0,0 --to 0,1,0 --vector 0,0,1\n"},
      {"matrix", "  taut matrix 'x^2+y^2+4z^2=1' --points points.csv --out distances.npy\n"},
      {"sample", "  taut sample 'x^2+y^2+4z^2=1' -n 100 --out points.csv\n"},
      {"voronoi", "  taut voronoi 'x^2+y^2+4z^2=1' --sources points.csv --out cells.ply\n"},
      {"mean", "  taut mean 'x^2+y^2+4z^2=1' --points points.csv\n"},
      {"curve",
       "  taut curve 'x^2+y^2+4z^2=1' --bezier controls.csv --out curve.csv\n"
       "  taut curve scan.ply --bezier controls.csv --degree 3 --out curve.html\n"},
      {"fit", "  taut fit scan.ply --out scan.taut\n"},
      {"mesh", "  taut mesh 'x^4+y^4+z^4=1' --out cube.obj\n"},
      {"info",
       "  taut info 'x^2+y^2+4z^2=1'\n"
       "  taut info 'x^2+y^2+4z^2=1' --at 1,0,0\n"},
      {"paper", "  taut paper figure1 --out report\n"},
  };
  return all;
}

}  // namespace

std::string examples_of(const std::string& command) {
  const auto found = examples().find(command);
  return found == examples().end() ? "" : "Examples:\n" + found->second;
}

}  // namespace taut::app
