// The pairs of sides worth a look in this step: two lists with margins, a far one from the cells and a near one from the far one, each made
// anew only when something has moved a quarter of its margin. What they leave out cannot touch, so their state never changes a result.
#pragma once

#include <span>
#include <vector>

#include "solver/fdem/contact/search.hpp"
#include "solver/fdem/contact/surface.hpp"

namespace fracfarm::fdem {

class NearPairs {
 public:
  explicit NearPairs(double mean_length) : far_margin_(0.1 * mean_length), near_margin_(0.02 * mean_length) {}

  // Takes the sides to where they are (rows of 8, m) and sees to the lists. A side that is new has not moved.
  template <class Real>
  void follow(const Surface& surface, const Real* displacement);
  // As if the sides had last been there: both lists are made anew at the next follow().
  void resume(std::vector<SideNow> last) { known_ = 0, now_ = std::move(last); }

  const std::vector<SideNow>& now() const { return now_; }
  const std::vector<SideNow>& before() const { return before_; }  // one follow() ago
  std::span<const SidePair> pairs() const { return near_; }       // sorted
  long searches() const { return searches_; }                     // by cells, since the start
  long selections() const { return selections_; }                 // of near pairs from far ones

 private:
  template <class Real>
  double move(const Surface& surface, const Real* displacement);
  double moved_since(const std::vector<SideNow>& then) const;
  void search(const Surface& surface);
  void select(const Surface& surface);
  void admit(const Surface& surface);
  void part(const Surface& surface);

  double far_margin_, near_margin_;  // m
  std::size_t known_ = 0;            // sides in the lists
  std::vector<SideNow> now_, before_;
  std::vector<SideNow> at_far_, at_near_;  // where the sides were when the lists were made
  std::vector<SidePair> far_, near_;
  std::vector<SidePair> cornered_;  // near, but at one corner of one body: may part when an edge there breaks
  CellSearch cells_;
  long searches_ = 0, selections_ = 0;
};

}  // namespace fracfarm::fdem
