// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_animation.h"

#include "error.h"
#include "scene/readers/gltf_accessors.h"
#include "scene/text_scanner.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

namespace clrt {

namespace {

/// Of two rotations with a larger cosine the chord is as good as the arc.
constexpr double SAME_ROTATION = 1 - 1e-9;

enum class Interpolation { STEP, LINEAR, CUBICSPLINE };

Interpolation interpolation_of(const JsonValue& sampler) {
    const std::string name = sampler.text("interpolation", "LINEAR");
    if (name == "STEP")
        return Interpolation::STEP;
    if (name == "LINEAR")
        return Interpolation::LINEAR;
    if (name == "CUBICSPLINE")
        return Interpolation::CUBICSPLINE;
    sampler.at("interpolation").fail("STEP, LINEAR or CUBICSPLINE");
}

/// The way from one rotation to another on the sphere of quaternions, by the shorter side.
glm::dvec4 turn_between(const glm::dvec4& from, glm::dvec4 to, double t) {
    double cosine = glm::dot(from, to);
    if (cosine < 0) {
        to = -to;
        cosine = -cosine;
    }
    if (cosine > SAME_ROTATION)
        return glm::mix(from, to, t);
    const double angle = std::acos(cosine);
    return (std::sin((1 - t) * angle) * from + std::sin(t * angle) * to) / std::sin(angle);
}

/// A value over time: key frames and what lies between them. A value is some numbers.
class Track {
public:
    using Value = std::vector<double>;

    /// The sampler of an animation. `element`: what its values are; SCALAR: any number of weights each.
    Track(GltfBuffers& buffers, const JsonValue& sampler, GltfElement element)
        : interpolation_(interpolation_of(sampler)), is_rotation_(element == GltfElement::VEC4),
          times_(read_gltf_numbers(buffers, sampler.at("input"), GltfElement::SCALAR)),
          values_(read_gltf_numbers(buffers, sampler.at("output"), element)) {
        check_times(sampler.at("input"));
        check_values(sampler.at("output"), element == GltfElement::SCALAR);
        width_ = values_.values.size() / (times_.count() * frame_size());
    }

    /// A rotation has length 1.
    Value at(double time) const {
        const auto begin = times_.values.begin(), end = times_.values.end();
        const size_t next = size_t(std::upper_bound(begin, end, float(time)) - begin); // as they are stored
        if (next == 0 || next == times_.count())
            return value(next ? next - 1 : 0);
        const double start = times_.values[next - 1], length = times_.values[next] - start;
        const double t = std::clamp((time - start) / length, 0., 1.);
        if (interpolation_ == Interpolation::STEP)
            return value(next - 1);
        if (interpolation_ == Interpolation::CUBICSPLINE)
            return spline(next, t, length);
        return is_rotation_ ? turned(value(next - 1), value(next), t)
                            : sum({{1 - t, value(next - 1)}, {t, value(next)}});
    }

private:
    void check_times(const JsonValue& input) const {
        const std::vector<float>& times = times_.values;
        if (times.empty())
            input.fail("a key frame", "none");
        const auto goes_back = [](float a, float b) { return !(a < b); };
        if (!std::isfinite(times.front()) || !std::isfinite(times.back()) ||
            std::adjacent_find(times.begin(), times.end(), goes_back) != times.end())
            input.fail("finite times that increase", "others");
    }

    void check_values(const JsonValue& output, bool of_any_width) const {
        const size_t expected = times_.count() * frame_size(), found = values_.count();
        const bool fits = of_any_width ? found > 0 && found % expected == 0 : found == expected;
        if (!fits)
            output.fail(fmt::format("{}{} values for {} times", of_any_width ? "a multiple of " : "",
                                    expected, times_.count()),
                        fmt::format("{}", found));
        const std::vector<float>& values = values_.values;
        if (!std::all_of(values.begin(), values.end(), [](float number) { return std::isfinite(number); }))
            output.fail("finite values", "others");
        for (size_t i = value_offset(); is_rotation_ && i < found; i += frame_size())
            if (values_.vec4(i) == glm::vec4(0))
                output.fail("quaternions other than 0", "0,0,0,0");
    }

    /// A frame of a spline is its incoming tangents, its values, its outgoing tangents.
    size_t frame_size() const { return interpolation_ == Interpolation::CUBICSPLINE ? 3 : 1; }
    size_t value_offset() const { return interpolation_ == Interpolation::CUBICSPLINE ? 1 : 0; }

    Value element(size_t i) const {
        const auto first = values_.values.begin() + std::ptrdiff_t(i * width_);
        return Value(first, first + std::ptrdiff_t(width_));
    }
    Value value(size_t frame) const { return sum({{1, element(frame * frame_size() + value_offset())}}); }

    /// Elements by factors; a rotation is brought to length 1.
    Value sum(const std::vector<std::pair<double, Value>>& parts) const {
        Value result(width_, 0);
        for (const auto& [factor, part] : parts)
            for (size_t i = 0; i < width_; ++i)
                result[i] += factor * part[i];
        const double length = std::sqrt(std::inner_product(result.begin(), result.end(), result.begin(), 0.));
        for (size_t i = 0; is_rotation_ && length > 0 && i < width_; ++i)
            result[i] /= length;
        return result;
    }

    static Value turned(const Value& a, const Value& b, double t) {
        const glm::dvec4 q = turn_between({a[0], a[1], a[2], a[3]}, {b[0], b[1], b[2], b[3]}, t);
        return {q.x, q.y, q.z, q.w};
    }

    Value spline(size_t next, double t, double length) const {
        const double t2 = t * t, t3 = t2 * t;
        const size_t from = 3 * (next - 1), to = 3 * next;
        return sum({{2 * t3 - 3 * t2 + 1, element(from + 1)},
                    {length * (t3 - 2 * t2 + t), element(from + 2)},
                    {3 * t2 - 2 * t3, element(to + 1)},
                    {length * (t3 - t2), element(to)}});
    }

    Interpolation interpolation_;
    bool is_rotation_;
    GltfNumbers times_, values_;
    size_t width_ = 0; ///< numbers a value
};

glm::dvec3 as_vector(const Track::Value& value) {
    return {value[0], value[1], value[2]};
}

glm::dvec4 as_rotation(const Track::Value& value) {
    return {value[0], value[1], value[2], value[3]};
}

/// Plays animations at one moment.
class Player {
public:
    Player(GltfBuffers& buffers, double time, NoticeList& notices)
        : buffers_(buffers), time_(time), notices_(notices) {}

    void play(const JsonValue& animation) {
        const std::vector<JsonValue> samplers = animation.at("samplers").elements();
        for (const JsonValue& channel : animation.at("channels").elements())
            play(channel, samplers);
    }

    GltfPoses take() { return std::move(poses_); }

private:
    void play(const JsonValue& channel, const std::vector<JsonValue>& samplers) {
        const JsonValue target = channel.at("target"), index = channel.at("sampler");
        const std::optional<JsonValue> node = target.find("node");
        if (index.whole() >= samplers.size())
            index.fail(fmt::format("an index of one of {} samplers", samplers.size()));
        if (!node) {
            notices_.add("an animation of what is no node's is left out", channel.place());
            return;
        }
        check_node(*node);
        GltfPose& pose = poses_[node->whole()];
        const std::string path = target.at("path").text();
        const auto value = [&](GltfElement element) {
            return Track(buffers_, samplers[index.whole()], element).at(time_);
        };
        if (path == "translation" && is_free(pose.translation.has_value(), channel))
            pose.translation = as_vector(value(GltfElement::VEC3));
        else if (path == "rotation" && is_free(pose.rotation.has_value(), channel))
            pose.rotation = as_rotation(value(GltfElement::VEC4));
        else if (path == "scale" && is_free(pose.scale.has_value(), channel))
            pose.scale = as_vector(value(GltfElement::VEC3));
        else if (path == "weights" && is_free(!pose.weights.empty(), channel))
            pose.weights = value(GltfElement::SCALAR);
    }

    /// Whether no animation has set a property before.
    bool is_free(bool is_set, const JsonValue& channel) {
        if (is_set)
            notices_.add(
                "two animations move the same node: the first is taken; --animation NAME chooses one",
                channel.place());
        return !is_set;
    }

    void check_node(const JsonValue& index) const {
        const JsonValue node = buffers_.file().json().element("nodes", index);
        if (const std::optional<JsonValue> matrix = node.find("matrix"))
            matrix->fail("translation, rotation and scale of a node that is animated", "a matrix");
    }

    GltfBuffers& buffers_;
    const double time_;
    NoticeList& notices_;
    GltfPoses poses_;
};

/// Those that are to be played. Throws where there are none.
std::vector<JsonValue> chosen_animations(const GltfFile& file, const std::string& wanted) {
    const std::vector<JsonValue> all = file.json().elements("animations");
    if (all.empty())
        throw SceneError(file.name(), 0, "--animation-time: expected a file with animations, found none");
    if (wanted.empty())
        return all;
    for (const JsonValue& animation : all)
        if (animation.text("name") == wanted)
            return {animation};
    std::vector<std::string> names;
    for (size_t i = 0; i < all.size(); ++i) {
        if (std::to_string(i + 1) == wanted)
            return {all[i]};
        names.push_back(fmt::format("{} {}", i + 1, clrt::quoted(all[i].text("name"))));
    }
    throw SceneError(file.name(), 0,
                     fmt::format("--animation: expected one of {}, found {}", fmt::join(names, ", "),
                                 clrt::quoted(wanted)));
}

} // namespace

GltfPoses read_gltf_poses(GltfBuffers& buffers, const GltfReading& reading, NoticeList& notices) {
    if (!reading.time) {
        if (!buffers.file().json().elements("animations").empty())
            notices.add(
                "animations are not played: the scene is shown as it stands; --animation-time SECONDS "
                "shows a moment of them",
                {buffers.file().name(), 0});
        return {};
    }
    Player player(buffers, *reading.time, notices);
    for (const JsonValue& animation : chosen_animations(buffers.file(), reading.animation))
        player.play(animation);
    return player.take();
}

} // namespace clrt
