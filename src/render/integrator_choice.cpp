// SPDX-License-Identifier: Apache-2.0
#include "render/integrator_choice.h"

#include "console/signals.h"
#include "film/film_file.h"
#include "options/path_refusals.h"
#include "render/guide_choice.h"
#include "render/reuse_choice.h"
#include "scene/slabs.h"
#include "seconds.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <utility>

namespace clrt {

namespace {

/// Why the options leave nothing but path; none: they do not.
std::optional<std::string> reason_for_path(const Options& options) {
    if (!options.transport.paths.empty())
        return "--paths tells paths apart";
    if (!options.output.path_layers.empty())
        return "--aov NAME=EXPR tells paths apart";
    if (options.transport.guide == Toggle::ON)
        return "--guide on guides paths from the eye";
    if (options.scene.texture_filter != TextureFilter::NONE)
        return "--texture-filter follows paths from the eye";
    return std::nullopt;
}

/// A guide for the sake of which bdpt is taken leaves a twentieth of its squared error at least: where others
/// have more than so many times its efficiency none is tried.
constexpr double LARGEST_GAIN_OF_GUIDE = 20;

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

/// Whether path may be as much better as a guide makes it, of which no pilot tells. Where lamps are behind
/// slabs no guide was better, in the three rooms where one was tried.
bool guides_path(const PlannedScene& planned, const PathPilot& unguided) {
    return !has_slabs_before_lamps(planned.scene) && is_guide_promising(planned, Integrator::PATH, unguided);
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

/// A replay is of the picture's integrator: while this lives, a plan has no pixel to replay.
class WithoutReplay {
public:
    explicit WithoutReplay(PlannedScene& planned)
        : pixel_(planned.options.run.pixel), kept_(std::exchange(pixel_, std::nullopt)) {}
    ~WithoutReplay() { pixel_ = std::move(kept_); }
    WithoutReplay(const WithoutReplay&) = delete;
    WithoutReplay& operator=(const WithoutReplay&) = delete;

private:
    std::optional<glm::ivec2>& pixel_;
    std::optional<glm::ivec2> kept_;
};

/// Decides by pilots: a candidate after the other, and then whether path that reuses paths gains as much as
/// the best of them.
class Decision {
public:
    Decision(const Device& device, std::shared_ptr<PlannedScene> planned, PreparedParts& parts,
             IntegratorChoice& choice)
        : device_(device), planned_(std::move(planned)), parts_(parts), choice_(choice),
          asked_(planned_->options.transport.max_depth) {
        if (is_measured_alone(*planned_))
            measured_ = choice.unguided;
    }

    void decide(const std::vector<Candidate>& candidates) {
        for (const Candidate& candidate : candidates)
            if (!is_out(candidate, options(), choice_) && !try_candidate(candidate))
                break;
        const std::string reuse = choice_.reason.empty() ? try_reuse() : "";
        if (choice_.integrator == Integrator::BDPT && !options().run.pixel)
            parts_.guide = guide_;
        if (choice_.reason.empty())
            choice_.reason = told_text(choice_, reuse);
        take(choice_.integrator, asked_, *planned_);
    }

private:
    const Options& options() const { return planned_->options; }

    /// Renders a candidate's pilot and chooses it if it is the best so far; false where no other is to be
    /// tried.
    bool try_candidate(const Candidate& candidate) {
        take(candidate.integrator, asked_, *planned_);
        const PreparedScene prepared = prepare_scene(device_, planned_, {parts_.tree, nullptr});
        parts_.tree = prepared.tree;
        const PilotResult pilot = run_pilot(prepared, choice_.pilot);
        if (stop_signal()) {
            choice_ = {};
            choice_.reason = "stopped by a signal";
            return false;
        }
        if (pilot.is_black) {
            choice_.reason = "a pilot finds no light";
            return false;
        }
        IntegratorPrice price = price_of(candidate, pilot, options());
        if (candidate.integrator == Integrator::PATH_LIGHT)
            choice_.caustics = caustic_errors(pilot);
        if (measured_)
            price = measured_price(price, *measured_, choice_.caustics, options());
        if (choice_.prices.empty())
            add_path(price, pilot);
        consider(price, prepared, {pilot.own, pilot.eye_rays, pilot.trimmed, pilot.mean});
        return true;
    }

    /// Adds what the first candidate's pilot tells of path, which is chosen as long as none is better.
    void add_path(const IntegratorPrice& price, const PilotResult& pilot) {
        const double trimmed = choice_.unguided ? choice_.unguided->trimmed : pilot.trimmed;
        const double rays = measured_ ? measured_->rays : pilot.eye_rays;
        choice_.unguided = PathPilot{price.path, rays, trimmed, pilot.mean};
        choice_.prices.push_back({Integrator::PATH, price.path, price.path, rays});
        is_guided_ = guides_path(*planned_, *choice_.unguided);
    }

    /// Chooses a candidate, for which the scene is prepared, if it is the best so far, with a guide or
    /// without.
    void consider(IntegratorPrice price, const PreparedScene& prepared, const PathPilot& unguided) {
        const double least = std::max(best_, smallest_gain(price, is_guided_, options()));
        std::shared_ptr<GuideProgress> guide;
        if (price.efficiency <= least)
            guide = guide_to_hits(prepared, unguided, least, price);
        choice_.prices.push_back(price);
        if (!(price.efficiency > least) && !guide) // nor where a pilot without noise makes it no number
            return;
        expect_program(device_, *planned_);
        best_ = std::max(price.efficiency, price.guided);
        chosen_ = choice_.prices.size() - 1;
        guide_ = guide;
        choice_.integrator = price.integrator;
        choice_.unguided = unguided;
    }

    /// A guide to hits that hardly any path makes, whatever the integrator, and that bdpt alone is guided to
    /// before any is made, if a pilot tells that bdpt is better with it than what has the efficiency `best`;
    /// else null.
    std::shared_ptr<GuideProgress> guide_to_hits(const PreparedScene& prepared, const PathPilot& unguided,
                                                 double best, IntegratorPrice& price) {
        const WithoutReplay without(*planned_);
        if (price.integrator != Integrator::BDPT || price.efficiency * LARGEST_GAIN_OF_GUIDE <= best ||
            !is_guide_promising(*planned_, Integrator::BDPT, unguided))
            return nullptr;
        const auto guide = std::make_shared<GuideProgress>(first_guide(prepared, unguided));
        if (!guide->error)
            return nullptr;
        price.guided = price.efficiency / (*guide->error * *guide->work);
        return guide->stage == GuideStage::ON && price.guided > best ? guide : nullptr;
    }

    /// Goes back from the chosen candidate to path where reusing paths gains as much there, by pilots, or
    /// where these find path better than was told; says what they tell of reuse, or nothing. Path is planned
    /// then, and the parts are its own. Path+light gains by reuse as well, so that path stays behind it.
    std::string try_reuse() {
        const bool is_path_light = choice_.integrator == Integrator::PATH_LIGHT;
        if (!chosen_ || best_ >= most_of_path(*planned_) || (guide_ && has_light_tree(*planned_)) ||
            (is_path_light && !is_measured_alone(*planned_)))
            return "";
        take(Integrator::PATH, asked_, *planned_);
        const std::optional<ReusePilots> pilots = reuse_pilots();
        const double gain = gain_beside_caustics(pilots, choice_.caustics, options());
        if (gain == 0)
            return "";
        IntegratorPrice& price = choice_.prices[*chosen_];
        if (is_measured_alone(*planned_))
            price = measured_price(price, pilots->alone, choice_.caustics, options());
        best_ = std::max(price.efficiency, price.guided);
        const bool reuses = !is_path_light && gain * gain_of_adaptive(options()) >= best_;
        if (reuses || best_ <= smallest_gain(price, is_guided_, options()))
            go_back_to_path(reuses && gain >= WORTHWHILE_REUSE_GAIN);
        return fmt::format("path that reuses paths {:.2g}", gain);
    }

    std::optional<ReusePilots> reuse_pilots() {
        const WithoutReplay without(*planned_);
        return run_reuse_pilots(device_, planned_, parts_);
    }

    void go_back_to_path(bool reuses) {
        choice_.integrator = Integrator::PATH;
        choice_.unguided.reset();
        if (reuses && !options().run.pixel) {
            parts_.programs = parts_.reusing;
            planned_->options.transport.path_reuse = Toggle::ON;
        }
    }

    const Device& device_;
    std::shared_ptr<PlannedScene> planned_;
    PreparedParts& parts_;
    IntegratorChoice& choice_;
    std::optional<int> asked_;          ///< --max-depth
    std::optional<PathPilot> measured_; ///< path's own pilot, where others' samples do not tell of path
    bool is_guided_ = false;            ///< a guide of path is promising
    double best_ = WORTHWHILE_GAIN_OF_INTEGRATOR;
    std::optional<size_t> chosen_;         ///< of the prices; none: path
    std::shared_ptr<GuideProgress> guide_; ///< of what is chosen
};

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
    return is_candidate(integrator) ? integrator : Integrator::PATH;
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
    } else if (planned.options.transport.path_reuse == Toggle::ON) {
        choice.reason = "--path-reuse on gives paths from the eye to several pixels";
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
    choice.integrator = Integrator::PATH; // until another is found better
    choice.is_told = wish == Toggle::ON;
    if (decide_by_facts(*planned, candidates, choice))
        take_integrator(choice.integrator, *planned);
    else {
        progress.update({"pilot", -1, 0, -1, -1});
        if (!path_suffices(device, planned, parts, choice)) {
            Decision(device, planned, parts, choice).decide(candidates);
            choice.is_told = true;
        }
    }
    if (choice.integrator != Integrator::PATH) {
        parts.programs.reset(); // path's, which pilots have taken
        parts.reusing.reset();
        expect_reuse(device, planned);
    }
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
