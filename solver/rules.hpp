// Work that is left out where it would change nothing, or nothing above a stated bound. Part of the method, not of a scene: every run has
// all of them, and a study switches them off one by one to measure what each saves and changes.
#pragma once

namespace fracfarm {

// psi is left as it is until somewhere it could rise by this much: psi - psi(0) <= max S / (m + S), S = 2 H and m = G_c / w_0 (with AT1
// max (2 H - threshold) / 2 H).
inline constexpr double least_damage = 1e-7;

struct Rules {
  bool linear_until_damage = true;      // no work on psi until it could rise by least_damage
  bool plastic_where_it_yields = true;  // the secant law on those tiles only that do: exact, up to rounding
  bool sweep_where_it_moves = true;  // after the first sweeps only rows whose psi moved by more than the solve's tolerance, and beside them
  bool work_where_it_moves = true;   // tiles that hardly change are left as they are for three of four steps
  // FDEM.
  bool contact_after_break = true;     // no search before the first broken edge, and around broken edges only
  bool damage_where_stretched = true;  // softening only where lambda > 1 or D > 0
  bool flow_where_it_yields = true;    // the radial return only where f > 0
};

}  // namespace fracfarm
