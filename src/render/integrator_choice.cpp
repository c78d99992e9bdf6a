// SPDX-License-Identifier: Apache-2.0
#include "render/integrator_choice.h"

#include "console/signals.h"
#include "film/film_file.h"
#include "options/path_refusals.h"
#include "render/guide_choice.h"
#include "render/render_params.h"
#include "render/reuse_choice.h"
#include "scene/slabs.h"
#include "seconds.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <spdlog/spdlog.h>
#include <utility>

namespace clrt {

namespace {

/// An integrator that has path's techniques and more, and what it costs in rays of path: its own rays from
/// the eye, of which every vertex is weighted against the other techniques and paths are followed one by one,
/// those from the lights and those between both, and a light path besides, which is begun. `pilot_eye` and
/// `pilot_light` are samples of path that a sample of its pilot costs, and a light path of it.
struct Candidate {
    Integrator integrator;
    double eye_ray, light_ray, inner_ray, light_path;
    double pilot_eye, pilot_light;
};

/// Rays within 10 % of the processor seconds of seven scenes with 3 to 11 rays a sample; pilots of path+light
/// 2.6 to 3.3 in all, of three.
constexpr Candidate CANDIDATES[] = {{Integrator::PATH_LIGHT, 1.35, 1, 0, 1.3, 1.7, 1.5},
                                    {Integrator::BDPT, 1.25, 1.2, 1, 1.3, 1.7, 1.5}};

/// Squared relative error of one sample of path, or of path+light, from which on others are tried where none
/// is named. Below it light is found without them, caustics apart, which path+light finds as well as bdpt.
constexpr double HARD_LIGHT_ERROR = 2;

/// What is expected to gain less than this is not taken: pilots were up to a third off.
constexpr double WORTHWHILE_GAIN = 1.1;
/// The same of bdpt where a guide of path is promising. With it path is 1.2 to 4 times as efficient there,
/// which no pilot so small can tell: of a door ajar one says 1.8 and of a corridor that is lit round a
/// corner 2.4.
constexpr double WORTHWHILE_GAIN_OVER_GUIDE = 2.4;

/// What path gains by samples that --adaptive has taken where they count, by ErrorMeasure; others take them
/// evenly. It was 1.2 to 3.4 by mse and 1.2 to 1.7 by relative in a Cornell box, over spheres on a plane and
/// beside a caustic. Where it was most, path+light gained 1.3 and 2.3 over it.
constexpr double GAIN_OF_ADAPTIVE[] = {2.7, 1.2};

/// Why the options leave nothing but path; none: they do not.
std::optional<std::string> reason_for_path(const Options& options) {
    if (!options.transport.paths.empty())
        return "--paths tells paths apart";
    if (!options.output.path_layers.empty())
        return "--aov NAME=EXPR tells paths apart";
    if (options.transport.guide == Toggle::ON)
        return "--guide on guides paths from the eye";
    if (options.transport.path_reuse == Toggle::ON)
        return "--path-reuse on gives paths from the eye to several pixels";
    if (options.scene.texture_filter != TextureFilter::NONE)
        return "--texture-filter follows paths from the eye";
    return std::nullopt;
}

/// Light paths of a pass for each pixel of the window.
double light_paths_a_sample(const Options& options) {
    const Crop window = render_window(options.film);
    return double(options.film.size.x) * double(options.film.size.y) /
           (double(window.x1 - window.x0) * double(window.y1 - window.y0));
}

/// A guide for the sake of which bdpt is taken leaves a twentieth of its squared error at least: where others
/// have more than so many times its efficiency none is tried.
constexpr double LARGEST_GAIN_OF_GUIDE = 20;

/// Whether there may be caustics that path meets by chance alone.
bool has_hard_caustics(const PlannedScene& planned) {
    return has_caustics(planned) && !path_connects_to_caustics(planned);
}

/// The candidates between whom pilots decide.
std::vector<Candidate> candidates_of(const PlannedScene& planned) {
    std::vector<Candidate> candidates;
    for (const Candidate& candidate : CANDIDATES)
        if (candidate.integrator != Integrator::PATH_LIGHT || has_hard_caustics(planned))
            candidates.push_back(candidate);
    return candidates;
}

/// Samples of path that a sample of every pilot costs, path's own included.
double pilot_work(const std::vector<Candidate>& candidates, const PlannedScene& planned) {
    const Options& options = planned.options;
    const bool has_own = options.transport.choose == Toggle::AUTO || has_slabs_before_lamps(planned.scene);
    double work = has_own ? 1 : 0;
    for (const Candidate& candidate : candidates)
        work += candidate.pilot_eye + candidate.pilot_light * light_paths_a_sample(options);
    return work;
}

/// What a candidate's pilot says of it. Its errors are compared with those that the same samples tell of
/// path.
IntegratorPrice price_of(const Candidate& candidate, const PilotResult& pilot, const Options& options) {
    IntegratorPrice price{candidate.integrator, pilot.own, pilot.path};
    price.work = candidate.eye_ray * pilot.eye_rays + candidate.light_ray * pilot.light_rays +
                 candidate.inner_ray * pilot.inner_rays + candidate.light_path * pilot.light_paths;
    price.efficiency = deciding_error(pilot.path, options) * pilot.eye_rays /
                       (deciding_error(pilot.own, options) * price.work);
    return price;
}

/// Of path, over others; 1: samples are even whatever is chosen.
double gain_of_adaptive(const Options& options) {
    return options.sampling.adaptive ? GAIN_OF_ADAPTIVE[size_t(*options.sampling.adaptive)] : 1;
}

/// The efficiency that an integrator must have over path's to be taken; `is_guided`: a guide of path is
/// promising.
double smallest_gain(const IntegratorPrice& price, bool is_guided, const Options& options) {
    const bool rivals_guide = is_guided && price.integrator == Integrator::BDPT;
    return rivals_guide ? WORTHWHILE_GAIN_OVER_GUIDE : WORTHWHILE_GAIN * gain_of_adaptive(options);
}

/// The longest path of an integrator: as long as path's, where no length is asked for.
std::optional<int> depth_of(Integrator integrator, std::optional<int> asked) {
    return asked || integrator_row(integrator).depth.usual >= USUAL_PATH_DEPTH ? asked : USUAL_PATH_DEPTH;
}

/// Has the plan rendered by an integrator.
void take(Integrator integrator, std::optional<int> asked, PlannedScene& planned) {
    planned.options.transport.max_depth = depth_of(integrator, asked);
    take_integrator(integrator, planned);
}

/// Has the program of a candidate's pilot compiled ahead, for a plan that is path's still.
void expect_pilot_of(Integrator candidate, const Device& device, const PlannedScene& planned) {
    Options options = planned.options;
    options.transport.integrator = candidate;
    options.transport.max_depth = depth_of(candidate, options.transport.max_depth);
    expect_pilot(device, planned, options);
}

/// Whether path finds the light by itself, as its pilot tells, and no other is asked about. Caustics it may
/// find so seldom that its pilot looks clean without them: there it only tells what path spends on slabs.
bool path_suffices(const Device& device, const std::shared_ptr<PlannedScene>& planned, PreparedParts& parts,
                   IntegratorChoice& choice) {
    const bool may_suffice =
        planned->options.transport.choose == Toggle::AUTO && !has_hard_caustics(*planned);
    if (!may_suffice && !has_slabs_before_lamps(planned->scene))
        return false;
    const PreparedScene prepared = prepare_path_pilot(device, planned, parts);
    choice.unguided = run_path_pilot(prepared, choice.pilot);
    const bool is_clean = choice.unguided->errors[size_t(ErrorMeasure::RELATIVE)] < HARD_LIGHT_ERROR;
    return may_suffice && (is_clean || stop_signal());
}

/// Whether the pilots so far have told that a candidate is not worth one, nor the program that is compiled
/// for it.
bool is_out(const Candidate& candidate, const Options& options, const IntegratorChoice& choice) {
    const auto finds_light = [](const IntegratorPrice& price) {
        return price.errors[size_t(ErrorMeasure::RELATIVE)] < HARD_LIGHT_ERROR;
    };
    return candidate.integrator == Integrator::BDPT && options.transport.choose == Toggle::AUTO &&
           std::any_of(choice.prices.begin(), choice.prices.end(), finds_light);
}

/// Whether path chooses lights by a tree, which candidates do without.
bool has_light_tree(const PlannedScene& planned) {
    return !planned.scene.light_tree.nodes.empty();
}

/// Whether path does what candidates do without: their samples tell what it would be without, too, and its
/// own pilot must tell.
bool is_measured_alone(const PlannedScene& planned) {
    return has_light_tree(planned) || has_slabs_before_lamps(planned.scene);
}

/// Path's errors by caustics, of which a pilot of path+light tells by its splats, and they alone: a pilot of
/// path's own meets them too seldom.
SquaredErrors caustic_errors(const PilotResult& pilot) {
    SquaredErrors errors{};
    for (size_t i = 0; i < errors.size(); ++i)
        errors[i] = std::max(0., pilot.path[i] - pilot.own[i]);
    return errors;
}

/// A price by what a pilot of path's own tells of path, and others of caustics, which it may have met or not.
void measure(const PathPilot& path, const SquaredErrors& caustics, const Options& options,
             IntegratorPrice& price) {
    for (size_t i = 0; i < caustics.size(); ++i)
        price.path[i] = std::max(path.errors[i], caustics[i]);
    price.efficiency = deciding_error(price.path, options) * path.rays /
                       (deciding_error(price.errors, options) * price.work);
}

/// What path gains by reusing paths where caustics are as noisy with it as without: 0 if pilots do not tell.
double gain_beside_caustics(const std::optional<ReusePilots>& pilots, const SquaredErrors& caustics,
                            const Options& options) {
    if (!pilots || pilots->gain == 0)
        return 0;
    const double alone = deciding_error(pilots->alone.errors, options);
    const double reusing = deciding_error(pilots->reusing.errors, options);
    const double caustic = deciding_error(caustics, options);
    const double work = alone / (reusing * pilots->gain);
    return std::max(alone, caustic) / (std::max(reusing, caustic) * work);
}

/// Up to which told efficiency a candidate is compared with path that reuses paths, which gains less than the
/// number of its pixels; a light tree gained up to 4 in rooms of many lamps. What connections through slabs
/// gain has no bound.
double most_of_path(const PlannedScene& planned) {
    if (has_slabs_before_lamps(planned.scene))
        return std::numeric_limits<double>::infinity();
    return REUSE_PIXELS * (has_light_tree(planned) ? 4 : 1);
}

/// Whether path may be as much better as a guide makes it, of which no pilot tells. Where lamps are behind
/// slabs no guide was better, in the three rooms where one was tried.
bool guides_path(const PlannedScene& planned, const PathPilot& unguided) {
    return !has_slabs_before_lamps(planned.scene) && is_guide_promising(planned, Integrator::PATH, unguided);
}

/// Goes back from the chosen candidate to path where reusing paths gains as much there, by pilots, or where
/// these find path better than was told; says what they tell of reuse, or nothing. Path is planned then and
/// `parts` are its own.
std::string try_path_again(const Device& device, const std::shared_ptr<PlannedScene>& planned,
                           std::optional<int> asked, bool is_guided, IntegratorPrice& price,
                           PreparedParts& parts, IntegratorChoice& choice) {
    take(Integrator::PATH, asked, *planned);
    // A replay is of the picture's integrator.
    const auto pixel = std::exchange(planned->options.run.pixel, std::nullopt);
    const std::optional<ReusePilots> pilots = run_reuse_pilots(device, planned, parts);
    planned->options.run.pixel = pixel;
    const Options& options = planned->options;
    const double gain = gain_beside_caustics(pilots, choice.caustics, options);
    if (gain == 0)
        return "";
    if (is_measured_alone(*planned))
        measure(pilots->alone, choice.caustics, options, price);
    const bool reuses = gain * gain_of_adaptive(options) >= price.efficiency;
    if (reuses || price.efficiency <= smallest_gain(price, is_guided, options)) {
        choice.integrator = Integrator::PATH;
        choice.unguided.reset();
        if (reuses && gain >= WORTHWHILE_REUSE_GAIN && !options.run.pixel) {
            parts.programs = parts.reusing;
            planned->options.transport.path_reuse = Toggle::ON;
        }
    }
    return fmt::format("path that reuses paths {:.2g}", gain);
}

/// What pilots have told, in words.
std::string told_text(const IntegratorChoice& choice, const std::string& reuse) {
    std::vector<std::string> told;
    for (const IntegratorPrice& price : choice.prices)
        told.push_back(
            fmt::format("{} {:.2g}{}", name_of(price.integrator), price.efficiency,
                        price.guided > 0 ? fmt::format(" ({:.2g} with its guide)", price.guided) : ""));
    if (!reuse.empty())
        told.push_back(reuse);
    return fmt::format("efficiency {} by pilots of {} x {} pixels, {} spp", fmt::join(told, ", "),
                       choice.pilot.width, choice.pilot.height, choice.pilot.spp);
}

/// A guide to hits that hardly any path makes, whatever the integrator, and that bdpt alone is guided to
/// before any is made, if a pilot tells that bdpt is better with it than what has the efficiency `best`; else
/// null.
std::shared_ptr<GuideProgress> guide_to_hits(const PreparedScene& prepared, const PathPilot& unguided,
                                             double best, IntegratorPrice& price) {
    if (price.integrator != Integrator::BDPT || price.efficiency * LARGEST_GAIN_OF_GUIDE <= best ||
        !is_guide_promising(*prepared.planned, Integrator::BDPT, unguided))
        return nullptr;
    const auto guide = std::make_shared<GuideProgress>(first_guide(prepared, unguided));
    if (!guide->error)
        return nullptr;
    price.guided = price.efficiency / (*guide->error * *guide->work);
    return guide->stage == GuideStage::ON && price.guided > best ? guide : nullptr;
}

/// Decides by pilots, a candidate after the other.
void decide(const Device& device, const std::shared_ptr<PlannedScene>& planned,
            const std::vector<Candidate>& candidates, PreparedParts& parts, IntegratorChoice& choice) {
    const std::optional<int> asked = planned->options.transport.max_depth;
    bool is_guided = false; // whether a guide of path is promising
    const std::optional<PathPilot> measured =
        is_measured_alone(*planned) ? choice.unguided : std::optional<PathPilot>();
    double best = WORTHWHILE_GAIN;
    size_t chosen = 0; // of the prices
    for (const Candidate& candidate : candidates) {
        if (is_out(candidate, planned->options, choice))
            continue;
        take(candidate.integrator, asked, *planned);
        const PreparedScene prepared = prepare_scene(device, planned, {parts.tree, nullptr});
        parts.tree = prepared.tree;
        const PilotResult pilot = run_pilot(prepared, choice.pilot);
        if (stop_signal()) {
            choice = {};
            choice.reason = "stopped by a signal";
            break;
        }
        if (pilot.is_black) {
            choice.reason = "a pilot finds no light";
            break;
        }
        IntegratorPrice price = price_of(candidate, pilot, planned->options);
        if (candidate.integrator == Integrator::PATH_LIGHT)
            choice.caustics = caustic_errors(pilot);
        if (measured)
            measure(*measured, choice.caustics, planned->options, price);
        if (choice.prices.empty()) {
            const double trimmed = choice.unguided ? choice.unguided->trimmed : pilot.trimmed;
            const double rays = measured ? measured->rays : pilot.eye_rays;
            choice.unguided = PathPilot{price.path, rays, trimmed, pilot.mean};
            choice.prices.push_back({Integrator::PATH, price.path, price.path, rays});
            is_guided = guides_path(*planned, *choice.unguided);
        }
        choice.prices.push_back(price);
        const PathPilot unguided{pilot.own, pilot.eye_rays, pilot.trimmed, pilot.mean};
        IntegratorPrice& told = choice.prices.back();
        const double least = std::max(best, smallest_gain(told, is_guided, planned->options));
        // A replay is of the picture's integrator.
        const auto pixel = std::exchange(planned->options.run.pixel, std::nullopt);
        if (told.efficiency <= least)
            parts.guide = guide_to_hits(prepared, unguided, least, told);
        planned->options.run.pixel = pixel;
        if (told.efficiency > least || parts.guide) {
            expect_program(device, *planned);
            best = std::max(told.efficiency, told.guided);
            chosen = choice.prices.size() - 1;
            choice.integrator = told.integrator;
            choice.unguided = unguided;
        }
    }
    const auto guide = std::exchange(parts.guide, nullptr);
    std::string reuse;
    if (choice.integrator != Integrator::PATH && choice.reason.empty() && best < most_of_path(*planned) &&
        !(guide && has_light_tree(*planned))) {
        IntegratorPrice guided = choice.prices[chosen];
        guided.efficiency = best;
        reuse = try_path_again(device, planned, asked, is_guided, guide ? guided : choice.prices[chosen],
                               parts, choice);
    }
    if (choice.integrator == Integrator::BDPT && !planned->options.run.pixel)
        parts.guide = guide;
    if (choice.reason.empty())
        choice.reason = told_text(choice, reuse);
    take(choice.integrator, asked, *planned);
}

/// Size of the pilots of all candidates; none where so small ones tell nothing.
std::optional<PilotSize> pilots_of(const std::vector<Candidate>& candidates, const PlannedScene& planned) {
    return size_of_pilots(pilot_work(candidates, planned), planned.options);
}

/// Whether others than path are looked at where none is named: not for short renders, nor for parts of a
/// picture, which are to be of one integrator however long they are. A film says what it goes on with.
bool may_try(const std::vector<Candidate>& candidates, const PlannedScene& planned) {
    if (!planned.options.film_file.resume_path.empty())
        return true;
    return planned.options.run.given.count("--first-sample") == 0 &&
           pilots_of(candidates, planned).has_value();
}

/// The integrator of a film that one of those chosen from has rendered; else path, which the film refuses.
Integrator integrator_of_film(const FilmIdentity& film) {
    const Integrator integrator = film_integrator(film);
    const bool is_candidate =
        std::any_of(std::begin(CANDIDATES), std::end(CANDIDATES),
                    [&](const Candidate& candidate) { return candidate.integrator == integrator; });
    return is_candidate ? integrator : Integrator::PATH;
}

/// The longest path of a film, which is usual or not by whether its integrator was named; none: it says none
/// that can be asked for.
std::optional<int> depth_of_film(const FilmIdentity& film) {
    const auto depth = film.find("max_depth");
    if (depth == film.end() || !depth->is_number_integer() || *depth < 1 || *depth > LARGEST_DEPTH)
        return std::nullopt;
    return depth->get<int>();
}

/// Decides by what the options and the scene say, and plans for paths as long as those of a film that is gone
/// on with unless a length is asked for; false where pilots must decide, whose size is set.
bool decide_by_facts(PlannedScene& planned, const std::vector<Candidate>& candidates,
                     IntegratorChoice& choice) {
    if (!planned.options.film_file.resume_path.empty()) {
        const FilmIdentity film = read_film_content(planned.options.film_file.resume_path).identity;
        choice.integrator = integrator_of_film(film);
        if (!planned.options.transport.max_depth)
            planned.options.transport.max_depth = depth_of_film(film);
        choice.reason = "as the film that is gone on with";
    } else if (const auto reason = reason_for_path(planned.options)) {
        choice.reason = *reason;
    } else if (planned.effects.paths.is_empty || candidates.empty()) {
        choice.reason = "there is nothing to choose";
    } else if (!planned.effects.paths.blind_spots.empty() && has_caustics(planned)) {
        choice.integrator = Integrator::PATH_LIGHT;
        choice.reason = fmt::format("path does not see {} ({})", planned.effects.paths.blind_spots[0].paths,
                                    planned.effects.paths.blind_spots[0].cause);
    } else if (const auto size = pilots_of(candidates, planned)) {
        choice.pilot = *size;
        return false;
    } else
        choice.reason = "too few samples for a pilot";
    return true;
}

} // namespace

std::optional<PilotSize> pilot_size(const PlannedScene& planned) {
    return pilots_of(candidates_of(planned), planned);
}

void expect_programs(const Device& device, const std::shared_ptr<PlannedScene>& planned) {
    if (!device.ahead)
        return;
    const std::vector<Candidate> candidates = candidates_of(*planned);
    const Toggle wish = planned->options.transport.choose;
    expect_program(device, *planned);
    expect_reuse(device, planned);
    IntegratorChoice facts;
    const bool is_open = wish == Toggle::ON || (wish == Toggle::AUTO && may_try(candidates, *planned));
    if (is_open && has_hard_caustics(*planned) && !decide_by_facts(*planned, candidates, facts))
        expect_pilot_of(candidates[0].integrator, device, *planned);
}

IntegratorChoice choose_integrator(const Device& device, const std::shared_ptr<PlannedScene>& planned,
                                   PreparedParts& parts, Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    IntegratorChoice choice;
    choice.integrator = planned->options.transport.integrator;
    const Toggle wish = planned->options.transport.choose;
    if (wish == Toggle::OFF)
        return choice;
    const std::vector<Candidate> candidates = candidates_of(*planned);
    if (wish == Toggle::AUTO && !may_try(candidates, *planned))
        return choice;
    choice.is_told = wish == Toggle::ON;
    if (decide_by_facts(*planned, candidates, choice))
        take_integrator(choice.integrator, *planned);
    else {
        progress.update({"pilot", -1, 0, -1, -1});
        if (!path_suffices(device, planned, parts, choice)) {
            decide(device, planned, candidates, parts, choice);
            choice.is_told = true;
        }
    }
    if (choice.integrator != Integrator::PATH)
        parts.programs.reset(); // path's, which pilots have taken
    if (planned->options.sampling.adaptive && !is_adaptive(planned->options))
        choice.reason += "; light paths reach all pixels, so that samples are even in spite of --adaptive";
    choice.is_told = choice.is_told || choice.integrator != Integrator::PATH;
    choice.seconds = seconds_since(start);
    progress.finish();
    if (choice.is_told)
        spdlog::info("integrator: {}", choice_text(choice));
    return choice;
}

std::string choice_text(const IntegratorChoice& choice) {
    return choice.is_told ? fmt::format("{}: {}", name_of(choice.integrator), choice.reason) : "";
}

} // namespace clrt
