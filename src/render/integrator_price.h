// SPDX-License-Identifier: Apache-2.0
// The integrators that may render a picture in path's place, and what pilots tell of each beside path: its
// squared error, its work in rays, and what it must gain to be taken (render/integrator_choice.h).
#pragma once

#include "render/pilot.h"
#include "render/reuse_choice.h"

#include <optional>
#include <vector>

namespace clrt {

/// An integrator that has path's techniques and more, and what it costs in rays of path: its own rays from
/// the eye, of which every vertex is weighted against the other techniques and paths are followed one by one,
/// those from the lights and those between both, and a light path besides, which is begun. `pilot_eye` and
/// `pilot_light` are samples of path that a sample of its pilot costs, and a light path of it.
struct Candidate {
    Integrator integrator;
    double eye_ray, light_ray, inner_ray, light_path;
    double pilot_eye, pilot_light;
};

/// What pilots say of an integrator, a sample a pixel.
struct IntegratorPrice {
    Integrator integrator = Integrator::PATH;
    SquaredErrors errors{}; ///< squared, by ErrorMeasure
    SquaredErrors path{};   ///< those of path, by the same samples or by path's own pilot, caustics apart
    double work = 0;        ///< in rays of path
    double efficiency = 1;  ///< 1 / (squared error times work), path's being 1
    double guided = 0;      ///< bdpt's with a guide that a pilot has judged; 0: none has
};

/// Squared relative error of one sample of path, or of path+light, from which on others are tried where none
/// is named. Below it light is found without them, caustics apart, which path+light finds as well as bdpt.
constexpr double HARD_LIGHT_ERROR = 2;

/// What is expected to gain less than this is not taken: pilots were up to a third off.
constexpr double WORTHWHILE_GAIN_OF_INTEGRATOR = 1.1;

/// Whether there may be caustics that path meets by chance alone.
bool has_hard_caustics(const PlannedScene& planned);

/// Whether an integrator is among those that may be chosen in path's place, of any scene.
bool is_candidate(Integrator integrator);

/// The candidates between whom pilots decide, in their order.
std::vector<Candidate> candidates_of(const PlannedScene& planned);

/// Samples of path that a sample of every pilot costs, path's own included.
double pilot_work(const std::vector<Candidate>& candidates, const PlannedScene& planned);

/// What a candidate's pilot says of it. Its errors are compared with those that the same samples tell of
/// path.
IntegratorPrice price_of(const Candidate& candidate, const PilotResult& pilot, const Options& options);

/// Whether path chooses lights by a tree, which candidates do without.
bool has_light_tree(const PlannedScene& planned);

/// Whether path does what candidates do without: their samples tell what it would be without, too, and its
/// own pilot must tell.
bool is_measured_alone(const PlannedScene& planned);

/// Path's errors by caustics, of which a pilot of path+light tells by its splats, and they alone: a pilot of
/// path's own meets them too seldom.
SquaredErrors caustic_errors(const PilotResult& pilot);

/// A price by what a pilot of path's own tells of path, and others of caustics, which it may have met or not;
/// with a guide it changes as without.
IntegratorPrice measured_price(IntegratorPrice price, const PathPilot& path, const SquaredErrors& caustics,
                               const Options& options);

/// What path gains by samples that --adaptive has taken where they count; 1: samples are even whatever is
/// chosen.
double gain_of_adaptive(const Options& options);

/// What path gains by reusing paths where caustics are as noisy with it as without: 0 if pilots do not tell.
double gain_beside_caustics(const std::optional<ReusePilots>& pilots, const SquaredErrors& caustics,
                            const Options& options);

/// The efficiency that an integrator must have over path's to be taken; `is_guided`: a guide of path is
/// promising.
double smallest_gain(const IntegratorPrice& price, bool is_guided, const Options& options);

/// Up to which told efficiency a candidate is compared with path that reuses paths, which gains less than the
/// number of its pixels; a light tree gained up to 4 in rooms of many lamps. What connections through slabs
/// gain has no bound.
double most_of_path(const PlannedScene& planned);

} // namespace clrt
