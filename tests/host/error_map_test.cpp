// SPDX-License-Identifier: Apache-2.0
// Where a picture's error is.
#include "film/error_map.h"

#include "film/film_error.h"
#include "support/noise_film.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace clrt {

TEST(ErrorMap, ItsRootMeanSquareIsThePicturesError) {
    std::mt19937 random(1);
    Film film = empty_film(37, 21, 4, 0, 64);
    fill_with_noise(film, 1, 2, random);
    for (size_t i = 0; i < film.sums.size(); i += 7) // unequal pixels
        film.sums[i] *= 3;
    for (const bool has_backdrop : {false, true}) {
        if (has_backdrop) {
            film.shown.assign(film_plane(film) / 3, 1);
            std::fill_n(film.shown.begin(), 200, std::uint8_t(0));
        }
        for (const ErrorMeasure measure : {ErrorMeasure::MSE, ErrorMeasure::RELATIVE}) {
            double sum = 0, pixels = 0;
            const std::vector<float> map = error_map(film, measure);
            ASSERT_EQ(map.size(), 37u * 21);
            for (size_t i = has_backdrop ? 200 : 0; i < map.size(); ++i, ++pixels)
                sum += double(map[i]) * double(map[i]);
            EXPECT_NEAR(std::sqrt(sum / pixels), film_error(film, ErrorPixels::SCENE, measure)->relative_rmse,
                        1e-5);
            if (has_backdrop)
                EXPECT_EQ(*std::max_element(map.begin(), map.begin() + 200), 0);
        }
    }
    EXPECT_TRUE(error_map(empty_film(4, 4, 4, 0, 64), ErrorMeasure::MSE).empty()) << "black";
    EXPECT_TRUE(error_map(empty_film(4, 4, 4, 0, 1), ErrorMeasure::MSE).empty()) << "one replicate";
}

} // namespace clrt
