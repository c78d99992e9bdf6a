// SPDX-License-Identifier: Apache-2.0
// Textures that are read by a second pair of texture coordinates: the picture is, to the last bit, that of
// the same coordinates as the first pair.
#include "effects/effects.h"
#include "kernels/shared/effects.h"
#include "render/kernels.h"
#include "support/render_scene.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

enum class Pair { FIRST, SECOND };

/// Coordinates that no triangle has by itself: u and v exchanged, and stretched.
std::vector<float> changed(const std::vector<float>& uvs) {
    std::vector<float> other;
    for (size_t i = 0; i < uvs.size(); i += 2)
        other.insert(other.end(), {2 * uvs[i + 1], 0.5f * uvs[i]});
    return other;
}

/// A floor, a leaf with holes and a lamp, each by pictures that are read by changed coordinates.
struct Mapped : TestScene {
    explicit Mapped(Pair pair) {
        std::vector<unsigned char> colours, mask;
        std::vector<float> spots;
        for (int i = 0; i < 64; ++i) {
            colours.insert(colours.end(),
                           {(unsigned char)(i * 97), (unsigned char)(i * 31), (unsigned char)(200 - i)});
            mask.push_back((unsigned char)(i * 53));
            spots.push_back(i == 9 || i == 44 ? 30.f : 1.f);
        }
        texture8("colours.png", 8, 8, 3, colours);
        texture8("mask.png", 8, 8, 1, mask);
        texture("spots.exr", 8, 8, 1, spots);
        build.material("floor", "Kd 0.8 0.8 0.8\nmap_Kd colours.png")
            .material("leaf", "Kd 0.5 0.7 0.2\nmap_d mask.png");
        build.material("lamp", "Kd 0 0 0\nKe 8 7 5\nmap_Ke spots.exr\nmap_d mask.png");
        build.use("floor").textured_quad({{-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}});
        build.use("leaf").textured_quad({{-1, 0.1, 0.5}, {1, 0.1, 0.5}, {1, 1.5, 0.3}, {-1, 1.5, 0.3}});
        build.use("lamp").textured_quad({{-1, 1.8, 0}, {0, 1.8, 0}, {0, 1.9, 0.5}, {-1, 1.9, 0.5}});
        look({0, 1.2, 3}, {0, 0.5, 0}, 45);
        options.sampling.spp = 256;
        options.effects.all = false;
        finish = [pair](Scene& scene) {
            (pair == Pair::FIRST ? scene.uvs : scene.second_uvs) = changed(scene.uvs);
            for (Texture& texture : scene.textures)
                texture.channel |= pair == Pair::SECOND ? TEXTURE_SECOND_UV : 0;
        };
    }
};

} // namespace

TEST(SecondUv, ThePictureIsThatOfTheSameCoordinatesInTheFirstPair) {
    for (const Integrator integrator : {Integrator::PATH, Integrator::BDPT, Integrator::WHITTED})
        for (const TextureFilter filter : {TextureFilter::NONE, TextureFilter::FOOTPRINT}) {
            const auto render = [&](Pair pair) {
                Mapped scene(pair);
                scene.options.transport.integrator = integrator;
                scene.options.scene.texture_filter = filter;
                return scene.render().film;
            };
            const Film first = render(Pair::FIRST), second = render(Pair::SECOND);
            EXPECT_TRUE(first.sums == second.sums) << name_of(integrator);
        }
}

TEST(SecondUv, IsAnEffectOfMaterialsThatReadBothPairs) {
    for (const Pair pair : {Pair::FIRST, Pair::SECOND}) {
        const Mapped scene(pair);
        const Effects effects = find_effects(scene.load(), scene.options);
        EXPECT_EQ((effects.mask & EFFECT_SECOND_UV) != 0, pair == Pair::SECOND);
    }
}

} // namespace clrt
