// SPDX-License-Identifier: Apache-2.0
// Meshes, a decoder of all layouts, a validator and a plain double-precision traversal for the tests of the
// bounding volume hierarchy.
#pragma once

#include "bvh/bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace clrt {

using Point = std::array<double, 3>;

struct Mesh {
    std::vector<vec4> positions;
    std::vector<Triangle> triangles;

    void add(u32 v0, u32 v1, u32 v2) {
        Triangle t{};
        t.v0 = v0, t.v1 = v1, t.v2 = v2;
        triangles.push_back(t);
    }
    void add(vec4 a, vec4 b, vec4 c) {
        const u32 first = u32(positions.size());
        positions.insert(positions.end(), {a, b, c});
        add(first, first + 1, first + 2);
    }
};

/// A closed bumpy ball of about 2 n^2 triangles with shared corners.
inline Mesh bumpy_ball(int n) {
    Mesh mesh;
    const double pi = std::acos(-1.0);
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) {
            const double theta = pi * i / n, phi = 2 * pi * (j % n) / n;
            const double s = i == 0 || i == n ? 0 : std::sin(theta);
            const double radius = 1 + 0.2 * s * std::sin(9 * theta) * std::cos(7 * phi);
            mesh.positions.push_back({float(radius * s * std::cos(phi)), float(radius * std::cos(theta)),
                                      float(radius * s * std::sin(phi)), 0});
        }
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const u32 a = u32(i * (n + 1) + j), b = a + u32(n) + 1;
            mesh.add(a, a + 1, b);
            mesh.add(a + 1, b + 1, b);
        }
    return mesh;
}

/// Unconnected triangles with corners up to `size` from random centres in the cube [-1,1]^3.
inline Mesh random_soup(int count, float size, unsigned seed) {
    Mesh mesh;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (int i = 0; i < count; ++i) {
        const float x = uniform(random), y = uniform(random), z = uniform(random);
        const auto corner = [&] {
            const float dx = uniform(random), dy = uniform(random), dz = uniform(random);
            return vec4{x + size * dx, y + size * dy, z + size * dz, 0};
        };
        const vec4 a = corner(), b = corner(), c = corner();
        mesh.add(a, b, c);
    }
    return mesh;
}

struct LeafTriangle {
    u32 index;
    Point corners[3];
};

/// A child that is not empty.
struct DecodedChild {
    double lower[3], upper[3];
    bool is_leaf;
    u32 node; ///< of an inner child
    std::vector<LeafTriangle> triangles;
};

/// What testing a leaf costs in units of a node's test: a block at once, or triangles one by one, which in
/// cwbvh take less time than eight quantised boxes.
inline double leaf_tests(BvhLayout layout, size_t triangles) {
    if (layout == BvhLayout::BVH8)
        return 1;
    return (layout == BvhLayout::BVH2 ? 1.0 : double(0.3f)) * double(triangles);
}

inline float word_as_float(u32 word) {
    float x;
    std::memcpy(&x, &word, sizeof x);
    return x;
}

inline DecodedChild decode_bvh8_child(const Bvh& bvh, const u32* node, int slot) {
    DecodedChild child{};
    for (int axis = 0; axis < 3; ++axis) {
        child.lower[axis] = word_as_float(node[16 * axis + slot]);
        child.upper[axis] = word_as_float(node[16 * axis + 8 + slot]);
    }
    const u32 reference = node[BVH8_CHILD_WORD + slot];
    child.is_leaf = (reference & BVH_LEAF_BIT) != 0;
    child.node = reference;
    if (!child.is_leaf)
        return child;
    const u32* block = &bvh.leaves.at(size_t(reference & ~BVH_LEAF_BIT) * BVH8_BLOCK_WORDS);
    for (int lane = 0; lane < BVH8_WIDTH; ++lane) {
        if (block[BVH8_BLOCK_ID_WORD + lane] == NO_INDEX)
            continue;
        LeafTriangle t{block[BVH8_BLOCK_ID_WORD + lane], {}};
        for (int corner = 0; corner < 3; ++corner)
            for (int axis = 0; axis < 3; ++axis)
                t.corners[corner][size_t(axis)] =
                    word_as_float(block[(3 * axis + corner) * BVH8_WIDTH + lane]);
        child.triangles.push_back(t);
    }
    return child;
}

inline LeafTriangle decode_leaf_triangle(const Bvh& bvh, size_t place) {
    const u32* words = &bvh.leaves.at(place * LEAF_TRIANGLE_WORDS);
    LeafTriangle t{words[3], {}};
    for (size_t corner = 0; corner < 3; ++corner)
        for (size_t axis = 0; axis < 3; ++axis)
            t.corners[corner][axis] = word_as_float(words[4 * corner + axis]);
    return t;
}

inline DecodedChild decode_bvh2_child(const Bvh& bvh, const u32* node, int slot) {
    DecodedChild child{};
    for (int axis = 0; axis < 3; ++axis) {
        const u32* planes = axis == 2 ? node + 8 + 2 * slot : node + 4 * slot + 2 * axis;
        child.lower[axis] = word_as_float(planes[0]);
        child.upper[axis] = word_as_float(planes[1]);
    }
    const u32 reference = node[BVH2_CHILD_WORD + slot];
    child.is_leaf = (reference & BVH_LEAF_BIT) != 0;
    child.node = reference;
    const u32 count = node[BVH2_COUNT_WORD + slot];
    for (u32 i = 0; i < count; ++i)
        child.triangles.push_back(decode_leaf_triangle(bvh, size_t(reference & ~BVH_LEAF_BIT) + i));
    return child;
}

inline u32 byte_of(const u32* words, size_t byte) {
    return reinterpret_cast<const unsigned char*>(words)[byte];
}

/// The step of a cwbvh node's lattice along an axis.
inline double cwbvh_step(const u32* node, size_t axis) {
    return std::ldexp(1.0, int(byte_of(node + CWBVH_EXPONENT_WORD, axis)) - CWBVH_EXPONENT_BIAS);
}

inline std::vector<DecodedChild> decode_cwbvh_children(const Bvh& bvh, const u32* node) {
    std::vector<DecodedChild> children;
    u32 next_node = node[CWBVH_CHILD_WORD];
    for (size_t slot = 0; slot < BVH8_WIDTH; ++slot) {
        const u32 meta = byte_of(node + CWBVH_META_WORD, slot);
        if (meta == 0)
            continue;
        DecodedChild child{};
        for (size_t axis = 0; axis < 3; ++axis) {
            const double origin = word_as_float(node[axis]), step = cwbvh_step(node, axis);
            child.lower[axis] = origin + byte_of(node + CWBVH_LOWER_WORD + 2 * axis, slot) * step;
            child.upper[axis] = origin + byte_of(node + CWBVH_UPPER_WORD + 2 * axis, slot) * step;
        }
        child.is_leaf = !(byte_of(node + CWBVH_EXPONENT_WORD, 3) >> slot & 1u);
        if (!child.is_leaf)
            child.node = next_node++;
        else
            for (u32 i = 0; meta >> CWBVH_COUNT_SHIFT >> i; ++i)
                child.triangles.push_back(
                    decode_leaf_triangle(bvh, size_t(node[CWBVH_TRIANGLE_WORD]) + (meta & 31u) + i));
        children.push_back(child);
    }
    return children;
}

/// Words of a layout's node.
inline size_t node_words(BvhLayout layout) {
    switch (layout) {
    case BvhLayout::BVH2:
        return BVH2_NODE_WORDS;
    case BvhLayout::CWBVH:
        return CWBVH_NODE_WORDS;
    case BvhLayout::BVH8:
        break;
    }
    return BVH8_NODE_WORDS;
}

/// The children of a node by ascending slot, empty ones left out.
inline std::vector<DecodedChild> decode_children(const Bvh& bvh, u32 node) {
    if (bvh.layout == BvhLayout::CWBVH)
        return decode_cwbvh_children(bvh, &bvh.nodes.at(size_t(node) * CWBVH_NODE_WORDS));
    const bool wide = bvh.layout == BvhLayout::BVH8;
    const u32* words = &bvh.nodes.at(size_t(node) * (wide ? BVH8_NODE_WORDS : BVH2_NODE_WORDS));
    std::vector<DecodedChild> children;
    for (int slot = 0; slot < (wide ? BVH8_WIDTH : 2); ++slot) {
        const u32 reference = words[(wide ? BVH8_CHILD_WORD : BVH2_CHILD_WORD) + slot];
        const float lower_x = word_as_float(words[wide ? slot : 4 * slot]);
        if (reference == BVH_LEAF_BIT && lower_x == BVH_EMPTY)
            continue;
        children.push_back(wide ? decode_bvh8_child(bvh, words, slot) : decode_bvh2_child(bvh, words, slot));
    }
    return children;
}

struct Hit {
    double t = std::numeric_limits<double>::infinity();
    u32 triangle = NO_INDEX;
};

struct Ray {
    Point origin, direction;
};

inline Point operator-(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Möller and Trumbore 1997 in double; at equal distance the lower index wins.
inline void intersect(const Ray& ray, const LeafTriangle& triangle, Hit& hit) {
    const Point e1 = triangle.corners[1] - triangle.corners[0],
                e2 = triangle.corners[2] - triangle.corners[0];
    const Point p = cross(ray.direction, e2), s = ray.origin - triangle.corners[0], q = cross(s, e1);
    const double det = dot(e1, p);
    if (det == 0)
        return;
    const double u = dot(s, p) / det, v = dot(ray.direction, q) / det, t = dot(e2, q) / det;
    if (!(u >= 0 && v >= 0 && u + v <= 1 && t > 0))
        return;
    if (t < hit.t || (t == hit.t && triangle.index < hit.triangle))
        hit = {t, triangle.index};
}

inline LeafTriangle triangle_of(const Mesh& mesh, u32 index) {
    const Triangle& t = mesh.triangles[index];
    LeafTriangle result{index, {}};
    const u32 corners[3] = {t.v0, t.v1, t.v2};
    for (size_t i = 0; i < 3; ++i) {
        const vec4& p = mesh.positions[corners[i]];
        result.corners[i] = {p.x, p.y, p.z};
    }
    return result;
}

/// Closest hit by testing all triangles.
inline Hit brute_force_hit(const Mesh& mesh, const Ray& ray) {
    Hit hit;
    for (u32 i = 0; i < mesh.triangles.size(); ++i)
        intersect(ray, triangle_of(mesh, i), hit);
    return hit;
}

/// Whether a ray comes within rounding of a box before `t_max`.
inline bool meets_box(const Ray& ray, const DecodedChild& child, double t_max) {
    constexpr double SLACK = 1e-12; // relative; double arithmetic loses under 1e-15 a step
    double near = 0, far = t_max;
    for (size_t axis = 0; axis < 3; ++axis) {
        const double o = ray.origin[axis], d = ray.direction[axis];
        const double a = child.lower[axis] - o, b = child.upper[axis] - o;
        const double slack = SLACK * std::max({std::abs(a), std::abs(b), std::abs(o)});
        if (d == 0) {
            if (a > slack || b < -slack)
                return false;
            continue;
        }
        near = std::max(near, std::min((a - slack) / d, (b + slack) / d));
        far = std::min(far, std::max((a - slack) / d, (b + slack) / d));
    }
    return near <= far * (1 + SLACK);
}

/// Closest hit by traversal; `nodes_visited`, if given, counts.
inline Hit traverse(const Bvh& bvh, const Ray& ray, size_t* nodes_visited = nullptr) {
    Hit hit;
    std::vector<u32> stack{0};
    while (!stack.empty()) {
        const u32 node = stack.back();
        stack.pop_back();
        if (nodes_visited)
            ++*nodes_visited;
        for (const DecodedChild& child : decode_children(bvh, node)) {
            if (!meets_box(ray, child, hit.t))
                continue;
            if (!child.is_leaf)
                stack.push_back(child.node);
            for (const LeafTriangle& triangle : child.triangles)
                intersect(ray, triangle, hit);
        }
    }
    return hit;
}

} // namespace clrt
