// SPDX-License-Identifier: Apache-2.0
// The automaton of --paths and of layers of paths (src/paths): a path carries a state, every scattering event
// is a letter that leads to the next one. The host gives the tables as literals (layout:
// shared/path_types.h); without them there is one state that accepts every path.
#ifndef CLRT_PATH_AUTOMATON_H
#define CLRT_PATH_AUTOMATON_H

#include "shared/effects.h"
#include "shared/path_types.h"
#include "shared/render_types.h"

#ifndef PATH_NEXT
#define PATH_NEXT 0u, 0x01010101u
#define PATH_STATES 0u, (KINDS_ALL | STATE_CONTINUES)
#endif
#ifndef PATH_LAYERS
#define PATH_LAYERS 0
#endif
/* Segments of the longest accepted path, where there is a longest. */
#ifndef PATH_SEGMENTS
#define PATH_SEGMENTS 0xffffffffu
#endif

constant uint AUTOMATON_NEXT[] = {PATH_NEXT};
constant uint AUTOMATON_STATES[] = {PATH_STATES};

/* The states behind a vertex, one for each letter that its BSDF may write. */
typedef struct {
    uint next[LETTER_COUNT];
} AutomatonStep;

/* The state that the table has behind a letter. */
static inline uint automaton_table(uint state, uint letter)
{
    return (AUTOMATON_NEXT[state] >> (NEXT_STATE_BITS * letter)) & NEXT_STATE_MASK;
}

/* The state behind a letter; dead too where the path has become too long to end within max_depth segments. */
static inline uint automaton_next(const RenderParams* params, uint state, uint letter, uint segment)
{
    const uint next = automaton_table(state, letter);
    const uint distance = AUTOMATON_STATES[next] >> STATE_DISTANCE_SHIFT;
    return segment + 1u + distance > params->max_depth ? STATE_DEAD : next;
}

/* All that may happen at the end of a segment. */
static inline AutomatonStep automaton_step(const RenderParams* params, uint state, uint segment)
{
    AutomatonStep step;
    for (uint letter = 0u; letter < LETTER_COUNT; ++letter)
        step.next[letter] = automaton_next(params, state, letter, segment);
    return step;
}

/* True if max_depth has closed a way that the expression leaves open. */
static inline bool automaton_is_cut(const AutomatonStep* step, uint state)
{
    uint open = 0u;
    for (uint letter = 0u; letter < LETTER_COUNT; ++letter)
        open |= step->next[letter] << (NEXT_STATE_BITS * letter);
    return open != AUTOMATON_NEXT[state];
}

/* The states behind the ways that max_depth has closed; dead behind all others. */
static inline AutomatonStep automaton_cut_step(const AutomatonStep* step, uint state)
{
    AutomatonStep cut;
    for (uint letter = 0u; letter < LETTER_COUNT; ++letter)
        cut.next[letter] = step->next[letter] != STATE_DEAD ? STATE_DEAD : automaton_table(state, letter);
    return cut;
}

/* True if light of this kind (KIND_*) ends an accepted path. */
static inline bool automaton_accepts(uint state, uint kind) { return (AUTOMATON_STATES[state] & kind) != 0u; }

/* The kinds of light that end a path in this state; all where paths are not told apart. */
static inline uint automaton_accepted(uint state)
{
    return HAS(EFFECT_PATH_FILTER) ? AUTOMATON_STATES[state] & STATE_KINDS_MASK : KINDS_ALL;
}

/* True if a ray that leaves in this state can find anything: false after the last surface before a point
   light. */
static inline bool automaton_continues(uint state)
{
    return (AUTOMATON_STATES[state] & STATE_CONTINUES) != 0u;
}

/* Letters (bits LETTER_BIT) that do not end the path. */
static inline uint automaton_open(const AutomatonStep* step)
{
    uint open = 0u;
    for (uint letter = 0u; letter < LETTER_COUNT; ++letter)
        open |= step->next[letter] != STATE_DEAD ? LETTER_BIT(letter) : 0u;
    return open;
}

/* Letters behind which a ray can find anything. */
static inline uint automaton_continuing(const AutomatonStep* step)
{
    uint found = 0u;
    for (uint letter = 0u; letter < LETTER_COUNT; ++letter)
        found |= automaton_continues(step->next[letter]) ? LETTER_BIT(letter) : 0u;
    return found;
}

/* Letters behind which light of this kind ends an accepted path. */
static inline uint automaton_accepting(const AutomatonStep* step, uint kind)
{
    uint found = 0u;
    for (uint letter = 0u; letter < LETTER_COUNT; ++letter)
        found |= automaton_accepts(step->next[letter], kind) ? LETTER_BIT(letter) : 0u;
    return found;
}

/* True if after this state the picture must know whether an event was matte or glossy. */
static inline bool automaton_splits(uint state) { return (AUTOMATON_STATES[state] & STATE_SPLITS) != 0u; }

#endif
