// SPDX-License-Identifier: Apache-2.0
// numerics/sampler.h: addressed random numbers. The host computes them anew, by definition instead of by
// tricks with bits, and the laws that rendering relies on are checked on the device's words.
#include "probes/kernel_probe.h"
#include "probes/random_inputs.h"
#include "probes/statistics.h"
#include "support/test_device.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <map>
#include <regex>

using namespace clrt;

namespace {

constexpr u32 PURPOSES = 16;

KernelProbe& probe() {
    static KernelProbe instance = [] {
        KernelProbe made(test_device(), {"numerics/sampler.h"});
        made.add<float(u32)>("unit", "sampler_unit(a)");
        made.add<float()>("unit_of_class", "sampler_unit(i << 8)");
        made.add<u32(u32)>("hash", "sampler_hash(a)");
        made.add<u32(u32)>("reverse", "sampler_reverse_bits(a)");
        made.add<u32(u32)>("pascal", "sampler_pascal_reversed(a)");
        made.add<u32(u32)>("partner_index", "sampler_partner_index(a)");
        made.add<u32(u32, u32)>("scramble", "sampler_scramble_reversed(a, b)");
        // a: seed, b: pixel, c: replicate, d: sample, e: bounce, f: purpose
        const std::string make = "const Sampler s = sampler_make(a, b, c, d); out = ";
        made.add<u32(u32, u32, u32, u32)>("key", make + "s.key;");
        made.add<u32(u32, u32, u32, u32, u32, u32)>("word", make + "sampler_word(&s, e, f);");
        const auto add_words = [&](const std::string& name, const std::string& words) {
            made.add<u32(u32, u32, u32, u32, u32, u32)>(name + "_x", make + words + ".x;");
            made.add<u32(u32, u32, u32, u32, u32, u32)>(name + "_y", make + words + ".y;");
        };
        add_words("pair", "sampler_pair_words(&s, e, f)");
        add_words("partner", "sampler_partner_words(&s, e, f)");
        add_words("light", "sampler_light_words(&s, e)");
        add_words("white", "sampler_independent_words(&s, sampler_address(e, f), false)");
        add_words("white_partner", "sampler_independent_words(&s, sampler_address(e, f), true)");
        made.add<float(u32, u32, u32, u32, u32, u32)>("number", make + "sampler_number(&s, e, f);");
        made.add<float(u32, u32, u32, u32, u32, u32)>("unit_x", make + "sampler_pair(&s, e, f).x;");
        made.add<float(u32, u32, u32, u32, u32, u32)>("unit_y", make + "sampler_pair(&s, e, f).y;");
        return made;
    }();
    return instance;
}

/// Addresses of random numbers, one array a part.
struct Addresses {
    std::vector<u32> seed, pixel, replicate, sample, bounce, purpose;

    void add(u32 s, u32 p, u32 r, u32 n, u32 b, u32 q) {
        seed.push_back(s);
        pixel.push_back(p);
        replicate.push_back(r);
        sample.push_back(n);
        bounce.push_back(b);
        purpose.push_back(q);
    }
    size_t size() const { return seed.size(); }
    template <class T>
    std::vector<T> run(const char* name) const {
        return probe().run<T>(name, seed, pixel, replicate, sample, bounce, purpose);
    }
};

// The host's version.

u32 hash(u32 x) {
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

u32 reverse(u32 x) {
    u32 reversed = 0;
    for (int bit = 0; bit < 32; ++bit)
        reversed |= (x >> bit & 1u) << (31 - bit);
    return reversed;
}

/// Sobol's second dimension by its direction numbers: the primitive polynomial x + 1.
u32 sobol_second(u32 index) {
    u32 point = 0, direction = 0x80000000u;
    for (int bit = 0; bit < 32; ++bit, direction ^= direction >> 1)
        point ^= (index >> bit & 1u) ? direction : 0u;
    return point;
}

/// The field of four elements, b0 + b1 w with w^2 = w + 1, as two bits.
u32 field_times(u32 a, u32 b) {
    u32 product = (b & 1u ? a : 0u) ^ (b & 2u ? a << 1 : 0u);
    return product & 4u ? product ^ 7u : product; // w^2 + w + 1 = 0
}

/// Of a natural number.
bool binomial_is_odd(u32 n, u32 k) {
    return (n & k) == k; // Lucas
}

/// A number whose base-4 digits are Pascal's triangle over that field times the digits of the index.
u32 partner_index(u32 index) {
    constexpr std::array<u32, 3> POWERS = {1, 2, 3}; // of w
    u32 result = 0;
    for (u32 row = 0; row < 16; ++row)
        for (u32 column = row; column < 16; ++column)
            if (binomial_is_odd(column, row))
                result ^= field_times(index >> 2 * column & 3u, POWERS[(column - row) % 3]) << 2 * row;
    return result;
}

/// Laine and Karras' hash with Vegdahl's constants.
u32 scramble_reversed(u32 x, u32 seed) {
    x ^= x * 0x3d20adeau;
    x = (x + seed) * (seed >> 16 | 1u);
    x ^= x * 0x05526c56u;
    return x ^ x * 0x53a22864u;
}

/// Nested uniform scrambling of a number.
u32 scramble(u32 x, u32 seed) {
    return reverse(scramble_reversed(reverse(x), seed));
}

struct HostWords {
    u32 word;
    std::array<u32, 4> net; ///< pair and partner
};

HostWords host_words(const Addresses& a, size_t i) {
    const u32 key = hash(a.pixel[i] ^ hash(a.replicate[i] + hash(a.seed[i] + 0x9e3779b9u)));
    const u32 address = (a.bounce[i] * PURPOSES + a.purpose[i]) * 0x9e3779b9u;
    const u32 pair_key = hash(key + address);
    const u32 index = scramble(a.sample[i], pair_key);
    const u32 other = partner_index(index);
    return {hash(hash(key ^ a.sample[i] * 0x85ebca6bu) + address),
            {scramble(reverse(index), pair_key * 0x9e3779b9u),
             scramble(sobol_second(index), pair_key * 0x85ebca6bu),
             scramble(reverse(other), pair_key * 0xc2b2ae35u),
             scramble(sobol_second(other), pair_key * 0x27d4eb2fu)}};
}

Addresses random_addresses(size_t count) {
    Random random(1);
    Addresses addresses;
    for (size_t i = 0; i < count; ++i)
        addresses.add(random.word() >> random.word() % 32, random.word() >> random.word() % 32,
                      random.word() % 8, random.word() >> random.word() % 32, random.word() % 64,
                      random.word() % PURPOSES);
    return addresses;
}

/// The first samples of one address.
Addresses samples_of(u32 seed, u32 pixel, u32 replicate, u32 bounce, u32 purpose, u32 count) {
    Addresses addresses;
    for (u32 sample = 0; sample < count; ++sample)
        addresses.add(seed, pixel, replicate, sample, bounce, purpose);
    return addresses;
}

/// True if 2^m points lie one in each interval of 2^-a by 2^-(m - a), for every a.
bool is_net(const std::vector<u32>& x, const std::vector<u32>& y, int m) {
    for (int a = 0; a <= m; ++a) {
        std::vector<bool> taken(size_t{1} << m);
        for (size_t i = 0; i < taken.size(); ++i) {
            const size_t column = a == 0 ? 0 : x[i] >> (32 - a);
            const size_t row = a == m ? 0 : y[i] >> (32 - (m - a));
            const size_t interval = (column << (m - a)) | row;
            if (taken[interval])
                return false;
            taken[interval] = true;
        }
    }
    return true;
}

/// True if 4^m points lie one in each box of 4^-a by 4^-b by 4^-c by 4^-d, for all a + b + c + d = m.
bool is_net_of_four(const std::array<std::vector<u32>, 4>& words, u32 m) {
    for (u32 a = 0; a <= m; ++a)
        for (u32 b = 0; a + b <= m; ++b)
            for (u32 c = 0; a + b + c <= m; ++c) {
                const std::array<u32, 4> digits = {a, b, c, m - a - b - c};
                std::vector<bool> taken(size_t{1} << 2 * m);
                for (size_t i = 0; i < taken.size(); ++i) {
                    size_t box = 0;
                    for (size_t d = 0; d < 4; ++d)
                        box = (box << 2 * digits[d]) |
                              (digits[d] == 0 ? 0 : words[d][i] >> (32 - 2 * digits[d]));
                    if (taken[box])
                        return false;
                    taken[box] = true;
                }
            }
    return true;
}

/// Words that occur twice; two arrays are compared as 64-bit words.
size_t repeats(const std::vector<u32>& high, const std::vector<u32>& low) {
    std::vector<uint64_t> words(high.size());
    for (size_t i = 0; i < words.size(); ++i)
        words[i] = uint64_t(high[i]) << 32 | low[i];
    std::sort(words.begin(), words.end());
    return words.size() - size_t(std::unique(words.begin(), words.end()) - words.begin());
}

/// p-value of independence of two arrays of words by their leading bits.
double independence_p_value(const std::vector<u32>& a, const std::vector<u32>& b) {
    constexpr u32 SIDE = 16;
    std::vector<double> counts(SIDE * SIDE);
    for (size_t i = 0; i < a.size(); ++i)
        ++counts[(a[i] >> 28) * SIDE + (b[i] >> 28)];
    return chi_squared_test(counts, std::vector<double>(counts.size(), double(a.size()) / (SIDE * SIDE)))
        .p_value;
}

/// Correlation coefficient times sqrt(count): standard normal for independent words.
double correlation_z(const std::vector<u32>& a, const std::vector<u32>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i)
        sum += (a[i] / 4294967296.0 - 0.5) * (b[i] / 4294967296.0 - 0.5);
    return sum * 12 / std::sqrt(double(a.size()));
}

} // namespace

TEST(Sampler, EveryNumberLiesStrictlyBetweenZeroAndOne) {
    const std::vector<float> units = probe().run_count<float>("unit_of_class", size_t{1} << 24);
    for (size_t i = 0; i < units.size(); ++i)
        ASSERT_EQ(units[i], float((i | 1) * FLOAT_U)) << i; // exact, and so is 1 - u
    EXPECT_GT(units.front(), 0);
    EXPECT_LT(units.back(), 1);
    EXPECT_EQ(1 - (1 - units.back()), units.back());
    EXPECT_EQ(1 - (1 - units.front()), units.front());
    EXPECT_EQ(probe().run<float>("unit", std::vector<u32>{0, 255, 256, 0x80000000u, 0xffffffffu}),
              (std::vector<float>{float(FLOAT_U), float(FLOAT_U), float(FLOAT_U), float(0.5 + FLOAT_U),
                                  float(1 - FLOAT_U)}));
}

TEST(Sampler, TheHashIsABijection) {
    // A hash that were a random function would repeat about 2048 of these.
    std::vector<u32> words(size_t{1} << 22);
    for (size_t i = 0; i < words.size(); ++i)
        words[i] = u32(i % 2 ? i / 2 : i * 0x9e3779b9u | 0x80000000u);
    std::sort(words.begin(), words.end());
    words.erase(std::unique(words.begin(), words.end()), words.end());
    std::vector<u32> hashed = probe().run<u32>("hash", words);
    EXPECT_EQ(repeats(hashed, std::vector<u32>(hashed.size())), 0u);
    for (size_t i = 0; i < words.size(); i += 97)
        ASSERT_EQ(hashed[i], hash(words[i]));
}

TEST(Sampler, BitTricksEqualTheirDefinitions) {
    Random random(2);
    std::vector<u32> words = {0, 1, 2, 3, 0x80000000u, 0xffffffffu};
    while (words.size() < 20000)
        words.push_back(random.word() >> random.word() % 32);
    const std::vector<u32> reversed = probe().run<u32>("reverse", words),
                           sobol = probe().run<u32>("pascal", words),
                           partner = probe().run<u32>("partner_index", words);
    for (size_t i = 0; i < words.size(); ++i) {
        ASSERT_EQ(reversed[i], reverse(words[i]));
        ASSERT_EQ(reverse(sobol[i]), sobol_second(words[i]));
        ASSERT_EQ(partner[i], partner_index(words[i]));
    }
}

TEST(Sampler, ScramblingABitDependsOnTheBitsBelowItAlone) {
    Random random(3);
    std::vector<u32> x, flipped, seed, bit;
    for (u32 i = 0; i < 32000; ++i) {
        bit.push_back(i % 32);
        x.push_back(random.word());
        flipped.push_back(x[i] ^ 1u << bit[i]);
        seed.push_back(random.word());
    }
    const std::vector<u32> a = probe().run<u32>("scramble", x, seed),
                           b = probe().run<u32>("scramble", flipped, seed);
    std::array<double, 32> higher{};
    for (size_t i = 0; i < x.size(); ++i) {
        const u32 difference = a[i] ^ b[i];
        ASSERT_EQ(difference & ((1u << bit[i]) - 1), 0u) << "bit " << bit[i];
        ASSERT_EQ(difference >> bit[i] & 1u, 1u) << "bit " << bit[i];
        higher[bit[i]] += bit[i] < 31 ? double(difference >> (bit[i] + 1) != 0) : 1;
    }
    // The low bits, which are the leading bits of the number, move some bit above them nearly always.
    for (size_t i = 0; i < 16; ++i)
        EXPECT_GT(higher[i], 900) << i;
}

TEST(Sampler, TheDeviceComputesTheHostsWords) {
    const Addresses addresses = random_addresses(100000);
    const std::vector<u32> word = addresses.run<u32>("word"), x = addresses.run<u32>("pair_x"),
                           y = addresses.run<u32>("pair_y"), partner_x = addresses.run<u32>("partner_x"),
                           partner_y = addresses.run<u32>("partner_y");
    const std::vector<float> number = addresses.run<float>("number"), unit_x = addresses.run<float>("unit_x"),
                             unit_y = addresses.run<float>("unit_y");
    const auto unit = [](u32 bits) { return float((bits >> 8 | 1u) * FLOAT_U); };
    for (size_t i = 0; i < addresses.size(); ++i) {
        const HostWords host = host_words(addresses, i);
        ASSERT_EQ(word[i], host.word) << i;
        ASSERT_EQ((std::array<u32, 4>{x[i], y[i], partner_x[i], partner_y[i]}), host.net) << i;
        ASSERT_TRUE(number[i] == unit(host.word) && unit_x[i] == unit(host.net[0]) &&
                    unit_y[i] == unit(host.net[1]))
            << i;
    }
}

TEST(Sampler, ThePairsOfEveryAddressAndTheirPartnersFormNets) {
    constexpr int LARGEST = 10;
    Random random(4);
    for (u32 k = 0; k < 96; ++k) {
        // All bounces and purposes of small numbers first, then anything.
        const bool small = k < 64;
        const Addresses addresses =
            samples_of(small ? 0 : random.word(), small ? k % 3 : random.word(), k % 8, k / PURPOSES,
                       small ? k % PURPOSES : random.word() % PURPOSES, 1u << LARGEST);
        const std::array<std::vector<u32>, 4> words = {
            addresses.run<u32>("pair_x"), addresses.run<u32>("pair_y"), addresses.run<u32>("partner_x"),
            addresses.run<u32>("partner_y")};
        for (int m = 0; m <= LARGEST; ++m) {
            ASSERT_TRUE(is_net(words[0], words[1], m)) << "2^" << m << " samples of address " << k;
            ASSERT_TRUE(is_net(words[2], words[3], m)) << "2^" << m << " samples of partner " << k;
        }
        for (u32 m = 0; 2 * m <= LARGEST; ++m)
            ASSERT_TRUE(is_net_of_four(words, m)) << "4^" << m << " samples of address " << k;
    }
}

TEST(Sampler, TheFirstVertexsLightSampleAndTheFilmPositionAreOneNet) {
    constexpr u32 FILM = 0, LIGHT = 3, SAMPLES = 256;
    const Addresses film = samples_of(5, 77, 1, 0, FILM, SAMPLES),
                    first = samples_of(5, 77, 1, 1, LIGHT, SAMPLES),
                    second = samples_of(5, 77, 1, 2, LIGHT, SAMPLES);
    EXPECT_TRUE(is_net_of_four({film.run<u32>("pair_x"), film.run<u32>("pair_y"), first.run<u32>("light_x"),
                                first.run<u32>("light_y")},
                               4));
    // Light samples of later vertices are pairs of their own.
    EXPECT_EQ(second.run<u32>("light_x"), second.run<u32>("pair_x"));
    EXPECT_EQ(second.run<u32>("light_y"), second.run<u32>("pair_y"));
}

TEST(Sampler, PixelsOfAReplicateNeverShareAKey) {
    constexpr size_t PIXELS = size_t{1} << 22;
    std::vector<u32> pixels(PIXELS);
    for (size_t i = 0; i < PIXELS; ++i)
        pixels[i] = u32(i);
    const std::vector<u32> seed(PIXELS, 7), replicate(PIXELS, 3), sample(PIXELS, 0);
    const std::vector<u32> keys = probe().run<u32>("key", seed, pixels, replicate, sample);
    EXPECT_EQ(repeats(keys, std::vector<u32>(PIXELS)), 0u);
    // Another sample of the same pixel goes on in the same sequence.
    EXPECT_EQ(probe().run<u32>("key", seed, pixels, replicate, std::vector<u32>(PIXELS, 99)), keys);
}

TEST(Sampler, DifferentAddressesHaveDifferentWords) {
    // Each part of the address varies in turn, the others are fixed; then bounce, purpose and sample
    // together.
    constexpr u32 COUNT = 1u << 18;
    std::array<Addresses, 6> sets;
    for (u32 i = 0; i < COUNT; ++i) {
        sets[0].add(1, i, 0, 0, 0, 0);
        sets[1].add(i, 5, 0, 0, 0, 0);
        sets[2].add(1, 5, 0, i, 0, 0);
        sets[3].add(1, 5, i % 8, i / 8, 3, 2);
        sets[4].add(1, 5, 0, i / 1024, i / PURPOSES % 64, i % PURPOSES);
        sets[5].add(1, 5, 0, i / (PURPOSES * 4096), i / PURPOSES % 4096, i % PURPOSES);
    }
    for (const Addresses& set : sets) {
        // Pairs of 64 random bits would repeat with probability 2e-9.
        const std::vector<u32> word = set.run<u32>("word");
        EXPECT_EQ(repeats(word, set.run<u32>("pair_x")), 0u);
        EXPECT_EQ(repeats(set.run<u32>("pair_x"), set.run<u32>("pair_y")), 0u);
        EXPECT_EQ(repeats(set.run<u32>("partner_x"), set.run<u32>("partner_y")), 0u);
        EXPECT_EQ(repeats(set.run<u32>("pair_x"), set.run<u32>("partner_x")), 0u);
        EXPECT_EQ(repeats(set.run<u32>("pair_y"), set.run<u32>("partner_y")), 0u);
        EXPECT_EQ(repeats(set.run<u32>("white_x"), set.run<u32>("white_y")), 0u);
        EXPECT_EQ(repeats(set.run<u32>("white_partner_x"), set.run<u32>("white_partner_y")), 0u);
        std::vector<double> counts(4096);
        for (const u32 w : word)
            ++counts[w >> 20];
        EXPECT_GT(chi_squared_test(counts, std::vector<double>(4096, COUNT / 4096.0)).p_value, SMALLEST_P);
    }
}

TEST(Sampler, NoTwoNumbersOfALongPathAreTheSame) {
    // All purposes of the 4096 segments that the longest path has by default: one word each, no word twice.
    Addresses path;
    for (u32 i = 0; i < 4097 * PURPOSES; ++i)
        path.add(7, 1234, 3, 9, i / PURPOSES, i % PURPOSES);
    std::vector<u32> words = path.run<u32>("word");
    std::sort(words.begin(), words.end());
    EXPECT_EQ(std::adjacent_find(words.begin(), words.end()), words.end());
}

TEST(Sampler, NumbersOfTwoAddressesAreIndependent) {
    constexpr u32 SAMPLES = 1024, PIXELS = 64;
    struct Address {
        u32 bounce, purpose;
    };
    const std::vector<std::array<Address, 2>> couples = {
        {{{0, 1}, {0, 3}}},   {{{0, 1}, {1, 1}}},     {{{1, 2}, {2, 1}}},      {{{0, 0}, {0, 1}}},
        {{{3, 3}, {63, 15}}}, {{{64, 1}, {4095, 1}}}, {{{4094, 6}, {4095, 2}}}};
    for (const auto& couple : couples) {
        std::array<Addresses, 2> sets;
        for (size_t side = 0; side < 2; ++side)
            for (u32 i = 0; i < SAMPLES * PIXELS; ++i)
                sets[side].add(0, i / SAMPLES, 0, i % SAMPLES, couple[side].bounce, couple[side].purpose);
        for (const char* first : {"pair_x", "partner_x", "partner_y", "word", "white_x", "white_y"})
            for (const char* second :
                 {"pair_x", "pair_y", "partner_x", "partner_y", "word", "white_x", "white_y"}) {
                const std::vector<u32> a = sets[0].run<u32>(first), b = sets[1].run<u32>(second);
                EXPECT_GT(normal_p_value(correlation_z(a, b)), SMALLEST_P) << first << " " << second;
                EXPECT_GT(independence_p_value(a, b), SMALLEST_P) << first << " " << second;
            }
    }
}

TEST(Sampler, EveryPurposeHasAnAddressOfItsOwn) {
    const std::string text = kernels_under_test().at("numerics/sampler.h");
    const std::regex definition("#define SAMPLE_(\\w+) (\\d+)u");
    std::map<u32, std::string> purposes;
    for (std::sregex_iterator match(text.begin(), text.end(), definition), end; match != end; ++match) {
        const u32 address = u32(std::stoul((*match)[2]));
        EXPECT_LT(address, PURPOSES) << (*match)[1] << " would be the next bounce's";
        const auto [other, is_new] = purposes.emplace(address, (*match)[1]);
        EXPECT_TRUE(is_new) << (*match)[1] << " and " << other->second;
    }
    EXPECT_GE(purposes.size(), 11u);
    EXPECT_NE(text.find(fmt::format("#define SAMPLER_PURPOSES {}u", PURPOSES)), std::string::npos);
}

TEST(Sampler, TheFourWordsOfANetAreIndependentOverPixels) {
    // Within a pixel they fill boxes evenly by design; one sample's words in many pixels are as chance gives.
    Addresses pixels;
    for (u32 i = 0; i < 1u << 16; ++i)
        pixels.add(0, i, 0, 5, 1, 1);
    const std::vector<std::string> names = {"pair_x",  "pair_y",  "partner_x",       "partner_y",
                                            "white_x", "white_y", "white_partner_x", "white_partner_y"};
    for (size_t a = 0; a < names.size(); ++a)
        for (size_t b = 0; b < a; ++b) {
            const std::vector<u32> x = pixels.run<u32>(names[a].c_str()),
                                   y = pixels.run<u32>(names[b].c_str());
            EXPECT_GT(independence_p_value(x, y), SMALLEST_P) << names[a] << " " << names[b];
            EXPECT_GT(normal_p_value(correlation_z(x, y)), SMALLEST_P) << names[a] << " " << names[b];
        }
}

TEST(Sampler, IndependentPairsAreWhiteNoise) {
    // One pixel's samples, one sample's pixels, one sample's addresses: each fills the square as chance does.
    constexpr u32 COUNT = 1u << 16;
    std::array<Addresses, 3> sets;
    for (u32 i = 0; i < COUNT; ++i) {
        sets[0].add(0, 7, 0, i, 1, 1);
        sets[1].add(0, i, 0, 3, 1, 1);
        sets[2].add(0, 7, 0, 3, i / PURPOSES, i % PURPOSES);
    }
    for (const Addresses& set : sets) {
        const std::vector<u32> x = set.run<u32>("white_x"), y = set.run<u32>("white_y"),
                               word = set.run<u32>("word"), partner = set.run<u32>("white_partner_x");
        EXPECT_GT(independence_p_value(x, y), SMALLEST_P);
        EXPECT_GT(normal_p_value(correlation_z(x, y)), SMALLEST_P);
        EXPECT_GT(independence_p_value(x, word), SMALLEST_P);
        EXPECT_GT(independence_p_value(y, word), SMALLEST_P);
        EXPECT_GT(independence_p_value(x, partner), SMALLEST_P);
        EXPECT_GT(independence_p_value(y, partner), SMALLEST_P);
        EXPECT_FALSE(is_net(x, y, 10));
    }
}

TEST(Sampler, NumbersOfTwoPixelsReplicatesAndSamplesAreIndependent) {
    constexpr u32 COUNT = 1u << 16;
    std::array<Addresses, 4> sets;
    for (u32 i = 0; i < COUNT; ++i) {
        const u32 pixel = i / 1024, sample = i % 1024;
        sets[0].add(0, pixel, 0, sample, 1, 1);
        sets[1].add(0, pixel + 1, 0, sample, 1, 1);
        sets[2].add(0, pixel, 1, sample, 1, 1);
        sets[3].add(0, pixel, 0, sample + 1, 1, 1);
    }
    for (size_t other = 1; other < sets.size(); ++other)
        for (const std::string name : {"pair_x", "pair_y", "partner_x", "partner_y", "word", "white_x",
                                       "white_y", "white_partner_x"}) {
            // Neighbouring samples of one net are dependent by design.
            if (other == 3 && name[0] == 'p')
                continue;
            const std::vector<u32> a = sets[0].run<u32>(name.c_str()), b = sets[other].run<u32>(name.c_str());
            EXPECT_GT(normal_p_value(correlation_z(a, b)), SMALLEST_P) << name << other;
            EXPECT_GT(independence_p_value(a, b), SMALLEST_P) << name << other;
        }
}
