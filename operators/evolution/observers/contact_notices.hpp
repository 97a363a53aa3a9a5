#pragma once
// What a user should know of the contact of a computation while it goes.
#include <map>
#include <optional>
#include <set>

#include "lacon/operators/contact/facet_gap.hpp"
#include "lacon/operators/evolution/evolution.hpp"
#include "lacon/operators/evolution/problem/free_bodies.hpp"
#include "lacon/operators/evolution/state_fields.hpp"

namespace lacon {

class ContactNotices : public EvolutionObserver {
 public:
  explicit ContactNotices(const Present& present)
      : present_(present), bodies_(present.problem.mesh), free_(free_bodies(present.problem, bodies_)) {
    if (present.contact) facet_gaps_.emplace(present.problem.mesh, *present.problem.contact, *present.contact);
  }

  /// EVOLUTION_6: patches that no displacement can move; EVOLUTION_17; EVOLUTION_22: patches that overlap because
  /// their skins have facets.
  void start(double instant) override;
  /// EVOLUTION_14: such patches inside their master; EVOLUTION_17; EVOLUTION_23: bodies that lie on others without a pressure;
  /// EVOLUTION_35: overlaps with RESOLUTION='NON'; EVOLUTION_66: zones that a step has flung apart. Throws EVOLUTION_36 for an
  /// overlap with STOP_INTERP='OUI'.
  void accept(const SolvedInstant& solved) override;
  /// EVOLUTION_16: of each zone the patch that its master has pierced deepest, of a zone where nothing has pressed at any
  /// instant also where that is little; EVOLUTION_45: likewise where a contact is missed while, or after, others press;
  /// EVOLUTION_43: zones whose skins never met; EVOLUTION_47 or 67: zones whose pressures alternate; EVOLUTION_60:
  /// zones whose straight edges leave a gap that counts; EVOLUTION_68: open patches with a part inside; EVOLUTION_65: zones
  /// whose pressures are near round-off; EVOLUTION_72: zones whose contact is smaller than the patches that carry it.
  void end(bool completed) override;
  /// Of a computation that has come to its end. Throws EVOLUTION_64 where nothing has pressed in any zone at any instant,
  /// though bodies have come to lie in each other: there is no force of contact in its result.
  void fail_if_all_missed() const;
  void save(const hdf5::Group& group) const override;
  void resume(const hdf5::Group& group) override;

 private:
  struct Pierced {
    double instant;
    PiercedPatch worst;
    template <class Use>
    void for_each_member(const Use& use) {
      use("instant", instant), use("patch", worst.patch), use("depth", worst.depth), use("gap", worst.gap);
    }
  };
  struct Alternating {
    double instant;
    AlternatingPressures most;
    template <class Use>
    void for_each_member(const Use& use) {
      use("instant", instant), use("share", most.share), use("patch", most.patch), use("in_rows", most.by);  // as bases call it
    }
  };
  struct Faceted {
    double instant;
    FacetGap facets;
    template <class Use>
    void for_each_member(const Use& use) {
      use("instant", instant), use("gap", facets.gap), use("give", facets.give);
    }
  };
  struct Split {
    double instant;
    SplitPatch worst;
    template <class Use>
    void for_each_member(const Use& use) {
      use("instant", instant), use("patch", worst.patch), use("share", worst.share), use("depth", worst.depth),
          use("far", worst.far);
    }
  };
  struct Coarse {
    double instant;
    CoarseContact contact;
    template <class Use>
    void for_each_member(const Use& use) {
      use("instant", instant), use("patch", contact.patch), use("share", contact.share), use("times", contact.times);
    }
  };
  struct Undecided {
    double instant, share;
    template <class Use>
    void for_each_member(const Use& use) {
      use("instant", instant), use("share", share);
    }
  };
  using PiercedZones = std::map<std::int32_t, Pierced>;
  /// What a run that goes on has to know: use(name, member).
  template <class Notices, class Use>
  static void for_each_record(Notices& notices, const Use& use);
  std::string first_cell(std::size_t patch) const;
  /// How much deeper it is than it was at the initial state of the zone.
  double came_in_by(std::int32_t zone, const Pierced& pierced) const;
  /// EVOLUTION_17, or 52 where COEF_MULT_APPA says how deep: couples of each zone that overlap too deep to be taken for
  /// contact, once a zone.
  void tell_what_is_too_deep(double instant);

  /// EVOLUTION_23, once a body.
  void tell_what_nothing_presses(double instant);

  /// Those of which a patch sees a master.
  std::set<std::size_t> zones_that_meet() const;

  /// EVOLUTION_66, once a zone; remembers which zones meet.
  void tell_what_was_flung(double instant);

  /// EVOLUTION_35, once a zone, or EVOLUTION_36.
  void tell_what_overlaps(double instant);

  Present present_;
  Bodies bodies_;
  std::set<std::int32_t> free_;  ///< bodies that are held by contact alone, and of which nothing was told
  PiercedZones pierced_;
  std::map<std::int32_t, double> depth_before_;      ///< of zones at the initial state, where that is worth an alarm
  PiercedZones pierced_at_rest_;                     ///< what is worth an alarm of zones where nothing has pressed
  std::set<std::int32_t> pressed_;                   ///< the others
  std::map<std::int32_t, double> strain_;            ///< of these, the largest that a pressure has made
  PiercedZones missed_;                              ///< of these, what nothing pressed at
  std::map<std::int32_t, Alternating> alternating_;  ///< zones whose pressures do, at the instant where they do most
  std::map<std::int32_t, Split> split_;              ///< zones with such a patch, at the instant where it is deepest
  std::map<std::int32_t, Faceted> faceted_;          ///< zones with such a gap, at the instant that strains them most
  std::map<std::int32_t, Coarse> coarse_;            ///< zones of so small a contact, at that instant
  std::map<std::int32_t, Undecided> undecided_;      ///< zones of so small pressures, at that instant
  std::vector<double> last_displacement_;            ///< of the last accepted state,
  std::set<std::size_t> last_met_;                   ///< and zones of which a patch had a master there
  std::set<std::size_t> flung_;                      ///< zones of which it has been told
  std::optional<FacetGaps> facet_gaps_;              ///< where there is contact
  bool started_ = false;                             ///< a state has been looked at
  std::set<std::size_t> met_;                        ///< zones of which a patch has had a master
  std::set<std::size_t> too_deep_;                   ///< zones of which it has been told
  std::set<std::size_t> overlapping_;                ///< likewise, of EVOLUTION_35
};

}  // namespace lacon
