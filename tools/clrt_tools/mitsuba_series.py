# SPDX-License-Identifier: Apache-2.0
"""Renders with Mitsuba 3 and measures what it took: a series that `clrt-study --against` reads (study_series.py)."""
import os
import resource
import time

# The list of the pictures; its form is in study_series.py.
LIST_FILE = "series.json"
# Paths that Mitsuba may trace at once: its LLVM variants keep all of them in memory.
WAVEFRONT = 2 ** 23
# Seed of the run that compiles, whose seconds do not count; far from those of the repeats, which count from 1.
WARM_UP_SEED = 20001
# Seeds of pictures whose mean alone counts.
MEAN_SEED = 10001
# Between the seeds that Mitsuba gets for two of ours: more than a picture has passes.
SEED_STEP = 4096


def samples_of_a_pass(spp, pixels):
    """The largest divisor of spp that keeps a pass within WAVEFRONT."""
    return max(count for count in range(1, spp + 1) if spp % count == 0 and (count == 1 or count * pixels <= WAVEFRONT))


class Renderer:
    """A scene in Mitsuba. `mitsuba`, `drjit`: the modules, a variant set. `threads`: that render; None: all."""

    def __init__(self, mitsuba, drjit, words, threads=None):
        self.mitsuba, self.drjit = mitsuba, drjit
        self.all_threads = drjit.thread_count()
        self.threads = threads or self.all_threads
        self.pixels = words["sensor"]["film"]["width"] * words["sensor"]["film"]["height"]
        self.scene = mitsuba.load_dict(words)

    def render(self, spp, seed):
        """(picture, wall seconds, user and system seconds). Passes of one picture have seeds of their own."""
        each = samples_of_a_pass(spp, self.pixels)
        self.drjit.set_thread_count(self.threads)
        before, begin = _cpu_seconds(), time.perf_counter()
        picture = 0
        for number in range(spp // each):
            picture += self.mitsuba.render(self.scene, spp=each, seed=seed * SEED_STEP + number)
            self.drjit.eval(picture)
        picture = picture / (spp // each)
        self.drjit.eval(picture)
        self.drjit.sync_thread()
        seconds, cpu_seconds = time.perf_counter() - begin, _cpu_seconds() - before
        # Mitsuba reads and writes EXR by a second thread, for which it would wait for ever.
        self.drjit.set_thread_count(max(self.all_threads, 2))
        return picture, seconds, cpu_seconds

    def series(self, counts, repeats, folder, say):
        """Renders all; writes the pictures into `folder`. Returns what series.json says of them, and (spp, mean) of each."""
        listed, means = [], []
        for spp in counts:
            say(f"{spp} spp, compiling")
            self.render(spp, WARM_UP_SEED)
        for seed in range(1, repeats + 1):
            for spp in counts:
                say(f"{spp} spp, seed {seed}")
                picture, seconds, cpu_seconds = self.render(spp, seed)
                name = f"spp{spp}_seed{seed}.exr"
                bitmap = self.mitsuba.Bitmap(picture)
                bitmap.write(os.path.join(folder, name))
                listed.append({"file": name, "spp": spp, "seed": seed, "seconds": seconds, "cpu_seconds": cpu_seconds})
                means.append((spp, mean_of(bitmap)))
        return listed, means


    def means(self, spp, count, say):
        """Of pictures of seeds that no series has."""
        found = []
        for seed in range(MEAN_SEED, MEAN_SEED + count):
            say(f"{spp} spp, seed {seed}, for the mean alone")
            found.append(mean_of(self.mitsuba.Bitmap(self.render(spp, seed)[0])))
        return found


def mean_of(bitmap):
    """Of the pixels and of R, G and B."""
    import numpy
    return float(numpy.asarray(bitmap, dtype=float)[..., :3].mean())


def _cpu_seconds():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime
