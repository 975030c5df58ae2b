// One simulation as it leaves the farm, in memory. The HDF5 grammar is in grammar.hpp beside this file; only this room includes HDF5.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/failure/failure.hpp"
#include "common/failure/series.hpp"
#include "common/scene/scene.hpp"
#include "common/scene/triangle_mesh.hpp"

namespace fracfarm {

// Phase field on the nodes of a regular grid; index = row * columns + column, row 0 at the bottom, float as it is stored.
struct PhaseFieldFrames {
  std::vector<double> x;                // m
  std::vector<double> z;                // m
  std::vector<double> time;             // s, one a frame, the first at 0
  std::vector<std::vector<float>> psi;  // one field a frame
  std::vector<float> psi_initial;
  std::vector<float> psi_failure;           // at time_to_failure, or the last state where there is none
  std::vector<unsigned char> mask_initial;  // 1 on held nodes
};

// FDEM on the undeformed mesh, by edge of it: 0 intact ... 1 broken, exactly 2 on the edges of the initial cracks. Float as it is stored:
// an edge that is not broken is given a value below 1, and stays below it.
struct FdemFrames {
  TriangleMesh mesh;
  std::vector<double> time;                // s, one a frame, the first at 0
  std::vector<std::vector<float>> damage;  // one value an edge, a frame
  std::vector<float> damage_initial;
  std::vector<float> damage_failure;      // at time_to_failure, or the last state where there is none
  std::vector<double> break_time;         // s by edge, not a number where it never broke, initial cracks among them
  std::vector<unsigned char> break_mode;  // by edge: 0 did not break, 1 in tension, 2 in shear, 3 in both
};

// The frames of its method, and empty ones of the others.
struct Record {
  std::string key;  // of the job: SHA-256 of canonical scene and solver build
  std::string canonical_scene;
  std::string method;
  std::string material;            // name, or "layers"
  std::string boundary_condition;  // uniaxial, biaxial, or "scene"
  std::uint64_t sample_id = 0;     // 0: not of a campaign
  std::uint64_t pattern_seed = 0;
  Judgement judgement;
  std::vector<FailureTime> failure_times;
  double peak_stress = 0.0;     // Pa
  std::vector<Segment> cracks;  // as drawn
  PhaseFieldFrames phase_field;
  FdemFrames fdem;
  Series series;
  double energy_residual = 0.0;  // worst |residual| over max external work
  std::map<std::string, std::string>
      provenance;  // build id, compiler, flags, CPU, library versions, settings, wall and CPU seconds, peak memory, attempt, kernel
};

// Of the frames of its method, s.
inline const std::vector<double>& frame_times(const Record& record) {
  return record.method == "fdem" ? record.fdem.time : record.phase_field.time;
}

}  // namespace fracfarm
