// Passes over triangles and joints, each over all blocks in chunks. Sums of the chunks are added in their order: the same bits for any
// number of threads, and whether triangles and joints take turns or not.
#include <algorithm>

#include "solver/fdem/followed.hpp"
#include "solver/fdem/solver.hpp"

namespace fracfarm::fdem {
namespace {

using Index = std::size_t;

int chunks_in(int blocks, int of) { return (blocks + of - 1) / of; }
Blocks chunk_of(int chunk, int blocks, int of) { return {chunk * of, std::min(blocks, (chunk + 1) * of)}; }

// job(blocks) over all blocks in chunks; the sums come back in the order of the chunks.
template <class Sums, class Job>
std::vector<Sums> in_chunks(int blocks, int of, int threads, const Job& job) {
  const int chunks = chunks_in(blocks, of);
  std::vector<Sums> sums(static_cast<Index>(chunks));
#pragma omp parallel for num_threads(threads) schedule(static) if (threads > 1)
  for (int chunk = 0; chunk < chunks; ++chunk) sums[static_cast<Index>(chunk)] = job(chunk_of(chunk, blocks, of));
  return sums;
}

void add(AdvanceSums& all, const AdvanceSums& part) { all.viscous += part.viscous, all.plastic += part.plastic; }

}  // namespace

template <class Real>
AdvanceSums Fdem<Real>::advance(double dt) {
  const View<Real> v = view();
  const auto job = [&](Blocks blocks) { return kernels_.advance(v, blocks, static_cast<Real>(dt)); };
  AdvanceSums all{};
  for (const AdvanceSums& part : in_chunks<AdvanceSums>(plan_.triangle_blocks(), triangle_chunk, threads_, job)) add(all, part);
  return all;
}

template <class Real>
TriangleSums Fdem<Real>::measure(double dt) const {
  const View<Real> v = view();
  const auto job = [&](Blocks blocks) { return kernels_.measure(v, blocks, static_cast<Real>(dt)); };
  TriangleSums all{};
  for (const TriangleSums& part : in_chunks<TriangleSums>(plan_.triangle_blocks(), triangle_chunk, threads_, job)) {
    all.stress_xx += part.stress_xx, all.stress_zz += part.stress_zz, all.elastic += part.elastic, all.joints += part.joints;
    all.plastic += part.plastic;
    all.viscous += part.viscous, all.kinetic += part.kinetic, all.fastest = std::max(all.fastest, part.fastest);
  }
  return all;
}

// Springs, and the followed joints that lie along their triangles.
template <class Real>
void Fdem<Real>::join() {
  const View<Real> v = view();
  const auto springs = [&](Blocks blocks) { return kernels_.join(v, blocks), '\0'; };
  const auto followed = [&](Blocks blocks) { return kernels_.follow(v, blocks); };
  in_chunks<char>(scratch_.springs.blocks(), triangle_chunk, threads_, springs);
  scratch_.gone = in_chunks<double>(scratch_.settled_blocks, followed_chunk, threads_, followed);
}

// Blocks from the first that are of the triangles before this chunk alone.
template <class Real>
int ready_before(const JointList<Real>& list, int chunk) {
  return chunk == 0 || list.ready.empty() ? 0 : list.ready[static_cast<Index>(chunk - 1)];
}

template <class Real>
void Fdem<Real>::join_springs(const View<Real>& v, Share& share, int chunk) const {
  const Blocks ready{ready_before(scratch_.springs, chunk), ready_before(scratch_.springs, chunk + 1)};
  int run = ready.begin;
  for (int b = ready.begin; b < ready.end; ++b) {
    if (scratch_.springs.first_chunk[static_cast<Index>(b)] >= share.begin) continue;
    kernels_.join(v, {run, b});
    share.springs.push_back(b), run = b + 1;
  }
  kernels_.join(v, {run, ready.end});
}

template <class Real>
void Fdem<Real>::join_followed(const View<Real>& v, Share& share, int chunk) const {
  const auto whole = [&](int blocks) {
    return blocks == scratch_.settled_blocks ? chunks_in(blocks, followed_chunk) : blocks / followed_chunk;
  };
  const std::vector<int>& first = scratch_.followed.first_chunk;
  for (int f = whole(ready_before(scratch_.followed, chunk)); f < whole(ready_before(scratch_.followed, chunk + 1)); ++f) {
    const Blocks blocks = chunk_of(f, scratch_.settled_blocks, followed_chunk);
    if (*std::min_element(first.begin() + blocks.begin, first.begin() + blocks.end) >= share.begin)
      scratch_.gone[static_cast<Index>(f)] = kernels_.follow(v, blocks);
    else
      share.followed.push_back(f);
  }
}

// A chunk of triangles, and then those joints both of whose triangles have moved, while these are still in the cache.
template <class Real>
AdvanceSums Fdem<Real>::advance_and_join(double dt) {
  const View<Real> v = view();
  const int chunks = chunks_in(plan_.triangle_blocks(), triangle_chunk);
  std::vector<AdvanceSums> sums(static_cast<Index>(chunks));
  scratch_.gone.assign(static_cast<Index>(chunks_in(scratch_.settled_blocks, followed_chunk)), 0.0);
  std::vector<Share> shares;
  for (int t = 0; t < threads_; ++t) shares.push_back({chunks * t / threads_, chunks * (t + 1) / threads_});
#pragma omp parallel for num_threads(threads_) schedule(static, 1) if (threads_ > 1)
  for (int t = 0; t < threads_; ++t) {
    Share& share = shares[static_cast<Index>(t)];
    for (int chunk = share.begin; chunk < share.end; ++chunk) {
      sums[static_cast<Index>(chunk)] =
          kernels_.advance(v, chunk_of(chunk, plan_.triangle_blocks(), triangle_chunk), static_cast<Real>(dt));
      if (t == 0) scratch_.clock.end(Stage::triangles);
      join_springs(v, share, chunk), join_followed(v, share, chunk);
      if (t == 0) scratch_.clock.end(Stage::joints);
    }
  }
  for (const Share& share : shares) {
    for (const int b : share.springs) kernels_.join(v, {b, b + 1});
    for (const int f : share.followed)
      scratch_.gone[static_cast<Index>(f)] = kernels_.follow(v, chunk_of(f, scratch_.settled_blocks, followed_chunk));
  }
  AdvanceSums all{};
  for (const AdvanceSums& part : sums) add(all, part);
  return all;
}

// What follows when joints have been joined: those that soften first, and those that came since joints were last settled.
template <class Real>
void Fdem<Real>::soften(double time) {
  follow_what_softens();
  const View<Real> v = view();
  const int settled = scratch_.settled_blocks, others = scratch_.followed.blocks() - settled;
  const auto followed = [&](Blocks blocks) { return kernels_.follow(v, {settled + blocks.begin, settled + blocks.end}); };
  for (const double lost : scratch_.gone) state_.ledger.fracture += lost;
  for (const double lost : in_chunks<double>(others, followed_chunk, threads_, followed)) state_.ledger.fracture += lost;
  note_breaks(time);
  if (is_unsettled(state_)) settle(plan_, state_, scratch_);
}

#define FRACFARM_INSTANTIATE(Real)                                               \
  template AdvanceSums Fdem<Real>::advance(double);                              \
  template TriangleSums Fdem<Real>::measure(double) const;                       \
  template void Fdem<Real>::join();                                              \
  template void Fdem<Real>::join_springs(const View<Real>&, Share&, int) const;  \
  template void Fdem<Real>::join_followed(const View<Real>&, Share&, int) const; \
  template AdvanceSums Fdem<Real>::advance_and_join(double);                     \
  template void Fdem<Real>::soften(double);
FRACFARM_INSTANTIATE(double)
FRACFARM_INSTANTIATE(float)
#undef FRACFARM_INSTANTIATE

}  // namespace fracfarm::fdem
