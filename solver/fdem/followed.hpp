// Which joints are springs and which are followed, with damage or near it, and where each lies in the kernels' blocks. A joint that has
// once been followed stays so. Joints join the followed ones as they stretch, wherever they are; now and then (`settle`) both kinds are put
// along the triangles again, so that neighbours in memory are neighbours in the body and no block of springs is half empty.
#pragma once

#include "solver/fdem/model.hpp"
#include "solver/law/edge.hpp"

namespace fracfarm::fdem {

// All joints that are not followed, along their triangles.
template <class Real>
void set_springs(const Plan& plan, Scratch<Real>& scratch);

// From now on the joint is followed, undamaged, with the last opening of a spring that it had, m.
template <class Real>
void follow(const Plan& plan, State<Real>& state, Scratch<Real>& scratch, int joint, const law::Ends<double>& opening);

// So many joints were followed since both lists were last settled that it pays again.
template <class Real>
bool is_unsettled(const State<Real>& state);
template <class Real>
void settle(const Plan& plan, State<Real>& state, Scratch<Real>& scratch);

// The same joints, springs and places as in the run that had these; the followed ones' numbers are the caller's. False where these are no
// joints of the plan.
template <class Real>
bool follow_again(const Plan& plan, State<Real>& state, Scratch<Real>& scratch, const std::vector<int>& joints, int settled);

// z of the damage.
template <class Real>
void set_kept(const State<Real>& state, Scratch<Real>& scratch, Curve curve);

}  // namespace fracfarm::fdem
