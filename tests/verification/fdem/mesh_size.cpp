// FD-13: one body of the dataset at twice, once and half the element size (seed paper, figure 12).
#include <fmt/format.h>

#include "common/picture/mesh_picture.hpp"
#include "tests/studies/fdem_study.hpp"
#include "tests/verification/desk.hpp"
#include "tests/verification/fdem/sample_cases.hpp"
#include "tests/verification/pictures.hpp"

namespace fracfarm::verification {
namespace {

using studies::FdemRun;

constexpr double sizes[]{0.006, 0.003, 0.0015};  // m
constexpr int side = 420, gap = 20, head = 44, caption = 26;

picture::Canvas draw(const std::vector<FdemRun>& runs) {
  picture::Canvas page(3 * side + 4 * gap, head + caption + side + gap + 400);
  page.text(gap, 28, "Shale, pattern 1 between plates: initial cracks blue, broken edges red, at 1.8 times the stress drop", picture::black,
            picture::Align::left, picture::Font::bold);
  Chart stress{"mean vertical stress", {"time", "s"}, {"stress", "Pa"}, {}};
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const int x = gap + static_cast<int>(k) * (side + gap);
    page.text(x, head + 16, fmt::format("h {} mm, {} triangles", 1e3 * sizes[k], runs[k].layout.mesh.triangles.size()));
    page.place(picture::draw_mesh(runs[k].layout.mesh, studies::broken_field(runs[k], runs[k].last_time), side), x, head + caption);
    const auto time = runs[k].series["step_time"], zz = runs[k].series["stress_zz"];
    stress.lines.push_back({fmt::format("h {} mm", 1e3 * sizes[k]), palette[k], {time.begin(), time.end()}, {zz.begin(), zz.end()}});
  }
  page.place(chart_page({stress}), gap, head + caption + side);
  return page;
}

}  // namespace

std::vector<Row> mesh_size(Desk& desk) {
  std::vector<FdemRun> runs;
  std::vector<double> stiffness;
  for (const double size : sizes) {
    desk.progress(fmt::format("h {} mm", 1e3 * size), 0.15 * static_cast<double>(runs.size()));
    Scene scene = studies::fdem_scene({"shale", "uniaxial", 1}, 2026);
    scene.fdem.element_size = size;
    runs.push_back(studies::run_fdem(scene));
    if (!runs.back().trouble.empty()) return {compare(runs.back().trouble, "", 1.0, 0.0, 0.0)};
    stiffness.push_back(studies::stiffness_of(runs.back(), scene));
  }
  std::vector<Row> rows;
  const FdemRun& middle = runs[1];
  for (const std::size_t k : {0U, 2U}) {
    const FdemRun& run = runs[k];
    const std::string h = fmt::format("h {} mm against 3 mm: ", 1e3 * sizes[k]);
    rows.push_back(compare(h + "stiffness", "", 1.0, stiffness[k] / stiffness[1], 0.10));
    rows.push_back(compare(h + "peak stress", "", 1.0, run.peak / middle.peak, 0.10));
    rows.push_back(report(h + "drop10", "", run.drop10.value_or(NAN) / middle.drop10.value_or(NAN)));
    rows.push_back(report(h + "broken length", "",
                          studies::broken_by(run, run.last_time).length / studies::broken_by(middle, middle.last_time).length));
  }
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const auto shares = studies::directions_by(runs[k], runs[k].last_time);
    rows.push_back(report(fmt::format("h {} mm: broken length within 15° of across the pull", 1e3 * sizes[k]), "%", 100.0 * shares[0]));
  }
  desk.add({"fdem_mesh_size", "The same cracks on three meshes (figure 12 of the seed paper).", draw(runs)});
  return rows;
}

}  // namespace fracfarm::verification
