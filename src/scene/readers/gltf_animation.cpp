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

/// A value over time: key frames and what lies between them.
class Track {
public:
    /// The sampler of an animation; `element`: what its values are.
    Track(GltfBuffers& buffers, const JsonValue& sampler, GltfElement element)
        : interpolation_(interpolation_of(sampler)), is_rotation_(element == GltfElement::VEC4),
          times_(read_gltf_numbers(buffers, sampler.at("input"), GltfElement::SCALAR)),
          values_(read_gltf_numbers(buffers, sampler.at("output"), element)) {
        check(sampler);
    }

    /// A rotation has length 1; x, y, z of other values.
    glm::dvec4 at(double time) const {
        const auto begin = times_.values.begin(), end = times_.values.end();
        const size_t next = size_t(std::upper_bound(begin, end, time) - begin);
        if (next == 0 || next == times_.count())
            return value(next ? next - 1 : 0);
        const double start = times_.values[next - 1], length = times_.values[next] - start;
        const double t = (time - start) / length;
        if (interpolation_ == Interpolation::STEP)
            return value(next - 1);
        if (interpolation_ == Interpolation::CUBICSPLINE)
            return normalised(spline(next, t, length));
        return is_rotation_ ? turn_between(value(next - 1), value(next), t)
                            : glm::mix(value(next - 1), value(next), t);
    }

private:
    void check(const JsonValue& sampler) const {
        const std::vector<float>& times = times_.values;
        if (times.empty())
            sampler.at("input").fail("a key frame", "none");
        if (std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) != times.end())
            sampler.at("input").fail("times that increase", "others");
        const size_t expected = times.size() * frame_size();
        if (values_.count() != expected)
            sampler.at("output").fail(fmt::format("{} values for {} times", expected, times.size()),
                                      fmt::format("{}", values_.count()));
        const auto is_wrong = [](float number) { return !std::isfinite(number); };
        if (std::any_of(values_.values.begin(), values_.values.end(), is_wrong))
            sampler.at("output").fail("finite values", "others");
        for (size_t frame = 0; is_rotation_ && frame < times.size(); ++frame)
            if (is_zero(element(frame * frame_size() + value_offset())))
                sampler.at("output").fail("quaternions other than 0", "0,0,0,0");
    }

    static bool is_zero(const glm::dvec4& q) { return q == glm::dvec4(0); }

    /// A frame of a spline is its incoming tangent, its value, its outgoing tangent.
    size_t frame_size() const { return interpolation_ == Interpolation::CUBICSPLINE ? 3 : 1; }
    size_t value_offset() const { return interpolation_ == Interpolation::CUBICSPLINE ? 1 : 0; }

    glm::dvec4 element(size_t i) const {
        return is_rotation_ ? glm::dvec4(values_.vec4(i)) : glm::dvec4(values_.vec3(i), 0);
    }
    glm::dvec4 value(size_t frame) const {
        return normalised(element(frame * frame_size() + value_offset()));
    }
    glm::dvec4 normalised(const glm::dvec4& found) const {
        const double length = glm::length(found);
        return is_rotation_ && length > 0 ? found / length : found;
    }

    glm::dvec4 spline(size_t next, double t, double length) const {
        const double t2 = t * t, t3 = t2 * t;
        const size_t from = 3 * (next - 1), to = 3 * next;
        return (2 * t3 - 3 * t2 + 1) * element(from + 1) + length * (t3 - 2 * t2 + t) * element(from + 2) +
               (3 * t2 - 2 * t3) * element(to + 1) + length * (t3 - t2) * element(to);
    }

    Interpolation interpolation_;
    bool is_rotation_;
    GltfNumbers times_, values_;
};

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
        if (!node) // a target of an extension
            return;
        check_node(*node);
        GltfPose& pose = poses_[node->whole()];
        const JsonValue& sampler = samplers[index.whole()];
        const std::string path = target.at("path").text();
        if (path == "translation")
            set(pose.translation, sampler, GltfElement::VEC3, channel);
        else if (path == "rotation")
            set(pose.rotation, sampler, GltfElement::VEC4, channel);
        else if (path == "scale")
            set(pose.scale, sampler, GltfElement::VEC3, channel);
        else
            notices_.add(path == "weights" ? "animated morph targets are left out"
                                           : "an animation of what is no node's place is left out",
                         channel.place());
    }

    void check_node(const JsonValue& index) const {
        const JsonValue node = buffers_.file().json().element("nodes", index);
        if (const std::optional<JsonValue> matrix = node.find("matrix"))
            matrix->fail("translation, rotation and scale of a node that is animated", "a matrix");
    }

    template <typename Vector>
    void set(std::optional<Vector>& property, const JsonValue& sampler, GltfElement element,
             const JsonValue& channel) {
        if (property)
            notices_.add(
                "two animations move the same node: the first is taken; --animation NAME chooses one",
                channel.place());
        else
            property = Vector(Track(buffers_, sampler, element).at(time_));
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
