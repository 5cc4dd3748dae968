// Distances from one source to every vertex of a mesh: Taut's fan against CGAL's heat method and exact polyhedral
// distances, in one run, one thread.
//
//   bench_field OPPONENT_FIELD [VERTICES] [polyhedral] [CLOUD ...]
//
// OPPONENT_FIELD: the program of that name. VERTICES: about how many a mesh has (default 25,000). CLOUD: point clouds
// or meshes; fits of all their samples take the place of the formulas, at a tolerance of 1e-6 and on meshes of the
// default size. The meshes are Taut's own, their vertices exactly on the surface. Prints a Markdown table: seconds cold
// (Taut: cells, fan and all targets; heat: factorization and one field), seconds of the next field on the same mesh
// (Taut: another source), errors relative to the farthest distance against Taut's, and Taut's own error against a
// tolerance of 1e-13 (of fits, 1e-7).

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "taut/io/read_point_cloud.hpp"
#include "taut/io/write_geometry.hpp"
#include "taut/query/distance.hpp"
#include "taut/query/surface_mesh.hpp"
#include "taut/surface/fit.hpp"
#include "taut/surface/formula.hpp"

namespace {

using taut::Index;
using taut::Vector;

/// Of the processor: other programs may run beside.
double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Case {
  const char* name;
  const char* formula;
  double cell25;  // gives about 25,000 vertices
};

constexpr Case kCases[] = {{"sphere", "x^2+y^2+z^2=1", 0.0277},
                           {"ellipsoid 1:1:0.5", "x^2+y^2+4z^2=1", 0.0232},
                           {"triaxial 3:2:1", "x^2/9+y^2/4+z^2=1", 0.0548},
                           {"torus 1, 0.4", "(x^2+y^2+z^2+1-0.16)^2=4*(x^2+y^2)", 0.0311},
                           {"tangle cube", "x^4-5x^2+y^4-5y^2+z^4-5z^2+11.8", 0.0776}};

/// What is measured on, and how exactly.
struct Subject {
  std::string name;
  taut::Surface surface;
  double cell;  // of the mesh; 0 = chosen
  double tolerance;
  double fine;  // tolerance that stands for the truth
  int repetitions;
};

struct Opponent {
  double cold = std::nan("");
  double next = std::nan("");
  double mean = std::nan("");
  double most = std::nan("");
};

Opponent ask(const std::string& program, const std::string& mesh, Index source, const std::string& method,
             const Vector& truth, const std::filesystem::path& folder) {
  Opponent result;
  const std::string out = (folder / "distances").string();
  const std::string times = (folder / "times").string();
  const std::string command =
      program + " " + mesh + " " + std::to_string(source) + " " + method + " " + out + " > " + times;
  if (std::system(command.c_str()) != 0) return result;
  double prepared = 0;
  double solved = 0;
  std::ifstream(times) >> prepared >> solved;
  result.cold = method == "heat" ? prepared : prepared + solved;
  result.next = method == "heat" ? solved : prepared + solved;
  Vector distance(truth.size());
  std::ifstream(out, std::ios::binary)
      .read(reinterpret_cast<char*>(distance.data()), static_cast<std::streamsize>(distance.size()) * 8);
  const Vector off = (distance - truth).cwiseAbs() / truth.maxCoeff();
  result.mean = off.mean();
  result.most = off.maxCoeff();
  return result;
}

void measure(const Subject& subject, const std::string& program, bool polyhedral, const std::filesystem::path& folder) {
  const taut::Context one{.threads = 1};
  const taut::Surface& surface = subject.surface;
  const taut::SurfaceMesh mesh = taut::display_mesh(surface, {.cell = subject.cell}, one);
  const std::string file = (folder / "mesh.off").string();
  taut::write_mesh(file, mesh);
  const Index n = mesh.vertices.cols();
  const Index source = n / 3;
  double cold = 1e9;
  double next = 1e9;
  taut::Distances u;
  for (int i = 0; i < subject.repetitions; ++i) {
    const double start = seconds();
    taut::DistanceSolver solver(surface, mesh.vertices.col(source), {},
                                {.tolerance = subject.tolerance, .paths = false}, one);
    u = solver.at(mesh.vertices);
    cold = std::min(cold, seconds() - start);
    const double again = seconds();
    solver.set_sources(mesh.vertices.col(source));
    (void)solver.at(mesh.vertices);
    next = std::min(next, seconds() - again);
  }
  taut::DistanceSolver fine(surface, mesh.vertices.col(source), {}, {.tolerance = subject.fine, .paths = false}, one);
  Vector truth = fine.at(mesh.vertices).distance;
  const Index num_exact = u.distance.array().isFinite().count();
  if (num_exact < n) {
    std::printf("| %s | %ld | all geodesics could be followed to %ld of them |\n", subject.name.c_str(),
                static_cast<long>(n), static_cast<long>(num_exact));
    return;
  }
  for (Index j = 0; j < n; ++j) {
    if (!std::isfinite(truth(j))) truth(j) = u.distance(j);  // beyond the fine fan's budget
  }
  const double off = ((u.distance - truth).cwiseAbs().array() / truth.array().max(1e-300)).maxCoeff();
  const Opponent heat = ask(program, file, source, "heat", truth, folder);
  std::printf("| %s | %ld | %.3f | %.3f | %.1e | %.3f | %.3f | %.1e, %.1e | %.1f", subject.name.c_str(),
              static_cast<long>(n), cold, next, off, heat.cold, heat.next, heat.mean, heat.most, heat.cold / cold);
  if (polyhedral) {
    const Opponent exact = ask(program, file, source, "polyhedral", truth, folder);
    std::printf(" | %.2f | %.1e | %.1f", exact.cold, exact.most, exact.cold / cold);
  }
  std::printf(" |\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_field OPPONENT_FIELD [VERTICES] [polyhedral] [CLOUD ...]\n");
    return 2;
  }
  const std::string program = argv[1];
  const double vertices = argc > 2 ? std::atof(argv[2]) : 25000;
  const bool polyhedral = argc > 3 && std::string(argv[3]) == "polyhedral";
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "taut_bench_field";
  std::filesystem::create_directories(folder);
  std::printf(
      "| surface | vertices | Taut cold, s | next, s | max error | heat cold, s | next, s | mean, max error | cold "
      "ratio%s |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | ---%s |\n",
      polyhedral ? " | polyhedral, s | max error | ratio" : "", polyhedral ? " | --- | --- | ---" : "");
  for (int i = 4; i < argc; ++i) {
    const taut::PointCloud cloud = taut::read_point_cloud(argv[i]);
    const taut::Surface surface = taut::make_surface(taut::fit_surface(cloud, {.method = taut::FitMethod::local}));
    measure({std::filesystem::path(argv[i]).filename().string(), surface, 0, 1e-6, 1e-7, 1}, program, polyhedral,
            folder);
  }
  for (const Case& c : kCases) {
    if (argc > 4) break;
    const double cell = c.cell25 * std::sqrt(25000 / vertices);
    measure({c.name, taut::parse_surface(c.formula), cell, 1e-9, 1e-13, 5}, program, polyhedral, folder);
  }
  std::filesystem::remove_all(folder);
  return 0;
}
