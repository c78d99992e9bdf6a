// SPDX-License-Identifier: Apache-2.0
// A box whose integrator is chosen, and what its pictures by each are worth.
#pragma once

#include "film/film_error.h"
#include "render/integrator_choice.h"
#include "support/render_scene.h"

#include <gtest/gtest.h>

namespace clrt {

/// A choice, and the plan that it leaves.
struct Chosen {
    IntegratorChoice choice;
    std::shared_ptr<PlannedScene> planned;
    PreparedParts parts;
};

inline Chosen choose(const TestScene& scene) {
    Chosen chosen{{}, plan_loaded(test_device(), scene.load(), scene.options), {}};
    Progress silent(Toggle::OFF, true);
    chosen.choice = choose_integrator(test_device(), chosen.planned, chosen.parts, silent);
    EXPECT_EQ(chosen.planned->options.transport.integrator, chosen.choice.integrator);
    return chosen;
}

/// A box with a lamp under its ceiling, and spheres on its floor.
struct Box : TestScene {
    Box() {
        build.material("matte", "Kd 0.6 0.6 0.6").material("lamp", "Kd 0 0 0\nKe 9 8 7");
        build.material("glass", "Ni 1.5\nillum 7");
        build.use("matte").floor(2);
        build.polygon({{-2, 0, -2}, {2, 0, -2}, {2, 3, -2}, {-2, 3, -2}});
        look({0, 1.5, 4}, {0, 1, 0}, 50);
        options.film.size = {64, 48};
        options.sampling.spp = 512; // with pilots of two integrators
        options.sampling.replicates = 4;
        options.light.environment = glm::dvec3(0);
        options.transport.choose = Toggle::ON;
    }
    void add_lamp(double side) {
        build.use("lamp").polygon(
            {{-side, 2.9, -side}, {side, 2.9, -side}, {side, 2.9, side}, {-side, 2.9, side}});
    }
    void add_glass() { build.use("glass").icosphere({0, 0.8, 0}, 0.5, 3, Facing::OUTWARD, Shading::SMOOTH); }
    /// A small lamp whose light is gathered by glass.
    void add_caustic() {
        add_lamp(0.05);
        add_glass();
    }

    Chosen choose() const { return clrt::choose(*this); }
    Integrator integrator() const { return choose().choice.integrator; }
};

/// Squared error of a sample a pixel by an integrator, over many.
inline double squared_error(const Box& box, Integrator integrator) {
    Options options = box.options;
    options.transport.integrator = integrator;
    options.transport.choose = Toggle::OFF;
    options.sampling.spp = 512;
    options.sampling.replicates = 64; // 8 samples each: nets as of a pilot
    const auto error =
        film_error(render_loaded(box.load(), options).film, ErrorPixels::SCENE, ErrorMeasure::RELATIVE);
    return error ? error->relative_rmse * error->relative_rmse * 512 : 0;
}

/// What a pilot says of an integrator; the choice has asked one.
inline IntegratorPrice price_of(const IntegratorChoice& choice, Integrator integrator) {
    for (const IntegratorPrice& price : choice.prices)
        if (price.integrator == integrator)
            return price;
    ADD_FAILURE() << name_of(integrator) << ": " << choice.reason;
    return {};
}

} // namespace clrt
