// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_cameras.h"

#include "scene/vectors.h"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace clrt {

namespace {

/// What the messages of lights call them.
constexpr const char* LIGHT_SOURCE = "KHR_lights_punctual";

/// A node's axis in the world, of length 1. Throws where a scale of 0 leaves none.
glm::dvec3 axis_of(const GltfNode& node, const glm::dvec3& axis) {
    const glm::dvec3 turned(node.world * glm::dvec4(axis, 0));
    const double length = glm::length(turned);
    if (!(length > 0) || !is_finite(turned))
        node.json.fail("a transform that leaves camera or light a direction", "one that is singular");
    return turned / length;
}

glm::dvec3 place_of(const GltfNode& node) {
    const glm::dvec3 place(node.world[3]);
    if (!is_finite(place))
        node.json.fail("a camera or light at a finite place", "an infinite one");
    return place;
}

double positive_number(const JsonValue& object, const char* key) {
    const JsonValue value = object.at(key);
    if (!(value.number() > 0))
        value.fail("a number above 0");
    return value.number();
}

void set_perspective(const JsonValue& perspective, FileCamera& camera) {
    const double yfov = positive_number(perspective, "yfov");
    if (yfov >= glm::radians(180.))
        perspective.at("yfov").fail("an angle below pi");
    camera.camera.fov_degrees = glm::degrees(yfov);
    if (perspective.find("aspectRatio"))
        camera.aspect = positive_number(perspective, "aspectRatio");
}

/// xmag and ymag are half of what is shown.
void set_orthographic(const JsonValue& orthographic, FileCamera& camera) {
    const double xmag = orthographic.at("xmag").number(), ymag = orthographic.at("ymag").number();
    if (xmag == 0 || ymag == 0)
        orthographic.fail("xmag and ymag other than 0", fmt::format("{} and {}", xmag, ymag));
    camera.camera.projection = PROJECTION_ORTHOGRAPHIC;
    camera.camera.ortho_height = 2 * std::fabs(ymag);
    camera.aspect = std::fabs(xmag / ymag);
}

std::optional<JsonValue> light_of(const JsonDocument& json, const GltfNode& node) {
    const std::optional<JsonValue> extensions = node.json.find("extensions");
    const auto use = extensions ? extensions->find("KHR_lights_punctual") : std::nullopt;
    if (!use)
        return std::nullopt;
    const JsonValue index = use->at("light");
    const std::vector<JsonValue> lights =
        json.root().at("extensions").at("KHR_lights_punctual").at("lights").elements();
    if (index.whole() >= lights.size())
        index.fail(fmt::format("an index of one of {} lights", lights.size()));
    return lights[index.whole()];
}

/// A spot's cone, whose light is that of a point light within the inner angle.
SpotCone cone_of(const JsonValue& light, const GltfNode& node) {
    const JsonValue spot = light.at("spot");
    const double outer = spot.number("outerConeAngle", glm::radians(45.)),
                 inner = spot.number("innerConeAngle", 0);
    if (!(inner >= 0 && inner <= outer && outer <= glm::radians(180.)))
        spot.fail("angles with 0 <= innerConeAngle <= outerConeAngle <= pi",
                  fmt::format("{} and {}", inner, outer));
    return {axis_of(node, {0, 0, -1}), glm::degrees(outer), glm::degrees(inner)};
}

glm::dvec3 light_colour(const JsonValue& light, GltfLights units) {
    std::array<double, 3> colour = {1, 1, 1};
    if (const std::optional<JsonValue> given = light.find("color"))
        colour = given->numbers<3>();
    const double intensity = light.number("intensity", 1);
    const glm::dvec3 result = glm::dvec3(colour[0], colour[1], colour[2]) * intensity;
    if (!is_finite(result) || result.x < 0 || result.y < 0 || result.z < 0)
        light.fail("a colour and an intensity not below 0",
                   fmt::format("{},{},{}", result.x, result.y, result.z));
    return units == GltfLights::BLENDER ? result / LUMENS_A_WATT : result;
}

} // namespace

void add_gltf_camera(const JsonDocument& json, const GltfNode& node, SceneDescription& scene) {
    const std::optional<JsonValue> index = node.json.find("camera");
    if (!index)
        return;
    const JsonValue camera = json.element("cameras", *index);
    FileCamera result;
    result.name = camera.text("name", node.name);
    const JsonValue type = camera.at("type");
    if (type.text() == "perspective")
        set_perspective(camera.at("perspective"), result);
    else if (type.text() == "orthographic")
        set_orthographic(camera.at("orthographic"), result);
    else
        type.fail("perspective or orthographic");
    result.camera.eye = place_of(node);
    result.camera.at = result.camera.eye + axis_of(node, {0, 0, -1});
    if (result.camera.at == result.camera.eye)
        node.json.fail("a camera so near the origin that a step of 1 moves it",
                       fmt::format("one at a distance of {:.3g}", glm::length(result.camera.eye)));
    result.camera.up = axis_of(node, {0, 1, 0});
    scene.cameras.push_back(result);
}

void add_gltf_light(const JsonDocument& json, const GltfNode& node, GltfLights units,
                    SceneDescription& scene) {
    const std::optional<JsonValue> light = light_of(json, node);
    if (!light)
        return;
    const glm::dvec3 colour = light_colour(*light, units);
    const JsonValue type = light->at("type");
    if (type.text() == "directional")
        scene.suns.push_back({axis_of(node, {0, 0, 1}), colour, 0, LIGHT_SOURCE});
    else if (type.text() == "point")
        scene.points.push_back({place_of(node), colour, std::nullopt, LIGHT_SOURCE});
    else if (type.text() == "spot")
        scene.points.push_back({place_of(node), colour, cone_of(*light, node), LIGHT_SOURCE});
    else
        type.fail("directional, point or spot");
}

} // namespace clrt
