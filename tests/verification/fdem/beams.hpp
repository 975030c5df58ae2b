// A beam of two arms that joints hold together along its middle, loaded by slowly moving sections. FD-6 and FD-7.
#pragma once

#include <vector>

#include "tests/verification/desk.hpp"
#include "tests/verification/fdem/bodies.hpp"
#include "tests/verification/pictures.hpp"

namespace fracfarm::verification {

struct Arms {
  double length;  // m, of the beam
  double arm;     // m, height of one arm
  int rows;       // of squares in an arm
  double crack;   // m, from the left end
  Material material;
  double square() const { return arm / rows; }
  double E() const { return *material.young / (1.0 - *material.poisson * *material.poisson); }  // plane strain
  double G() const { return material.elasticity.C55; }
};

// Triangles tied together but for the middle, where the crack is open and the rest has joints.
fdem::Body beam_body(const Arms& arms);

// All nodes of a section move along z.
fdem::Told section(const fdem::Body& body, double x, double low, double high, std::function<double(double)> velocity);

struct Reading {
  double time, force, deflection;  // s, N/m, m
  double crack;                    // m, from the left end to the foremost broken joint
  double zone;                     // m, from there to the foremost damaged one
  double fracture, kinetic, work;  // J/m
};

// Runs until the crack is `until` (m) long or the time is up; the force is the reaction of the section that has a side.
std::vector<Reading> load_beam(Desk& desk, const Arms& arms, fdem::Body body, double until, double limit);

}  // namespace fracfarm::verification
