# SPDX-License-Identifier: Apache-2.0
"""Mitsuba 3 as a renderer to compare with."""
from clrt_tools.mitsuba_scene import scene_dictionary
from clrt_tools.peer_series import WARM_UP_SEED, Failure, Peer, PeerScene, missing_package

# Paths that Mitsuba may trace at once: its LLVM variants keep all of them in memory.
WAVEFRONT = 2 ** 23
# Between the seeds that Mitsuba gets for two of ours: more than a picture has passes.
SEED_STEP = 4096


def samples_of_a_pass(spp, pixels):
    """The largest divisor of spp that keeps a pass within WAVEFRONT."""
    return max(count for count in range(1, spp + 1) if spp % count == 0 and (count == 1 or count * pixels <= WAVEFRONT))


class MitsubaScene(PeerScene):
    """A scene in Mitsuba. `mitsuba`, `drjit`: the modules, a variant set. `threads`: that render; None: all."""

    def __init__(self, mitsuba, drjit, words, title, threads=None):
        self.mitsuba, self.drjit, self.title = mitsuba, drjit, title
        self.all_threads = drjit.thread_count()
        self.threads = threads or self.all_threads
        self.pixels = words["sensor"]["film"]["width"] * words["sensor"]["film"]["height"]
        self.scene = mitsuba.load_dict(words)

    def warm_up(self, spp):
        self.render(spp, WARM_UP_SEED)

    def render(self, spp, seed):
        """Passes of one picture have seeds of their own."""
        each = samples_of_a_pass(spp, self.pixels)
        self.drjit.set_thread_count(self.threads)
        picture = 0
        for number in range(spp // each):
            picture += self.mitsuba.render(self.scene, spp=each, seed=seed * SEED_STEP + number)
            self.drjit.eval(picture)
        picture = picture / (spp // each)
        self.drjit.eval(picture)
        self.drjit.sync_thread()
        return picture

    def _bitmap(self, source):
        # Mitsuba reads and writes EXR by a second thread, for which it would wait for ever.
        self.drjit.set_thread_count(max(self.all_threads, 2))
        return self.mitsuba.Bitmap(source)

    def write(self, picture, path):
        self._bitmap(picture).write(path)

    def mean(self, picture):
        import numpy
        return float(numpy.asarray(self._bitmap(picture), dtype=float)[..., :3].mean())

    def mean_of_file(self, path):
        return self.mean(path)


class Mitsuba(Peer):
    """The program clrt-mitsuba."""
    program, name, packages = "clrt-mitsuba", "Mitsuba 3", "mitsuba and numpy"

    def add_options(self, add):
        add("--sampler", default="independent", metavar="NAME", help="Mitsuba's, such as multijitter (default independent)")
        add("--variant", default="llvm_ad_rgb", metavar="NAME", help="Mitsuba's, of RGB colours (default llvm_ad_rgb)")

    def open(self, scene, options, folder):
        try:
            import drjit
            import mitsuba
            import numpy  # noqa: F401 (MitsubaScene.mean needs it)
        except ImportError as error:
            raise missing_package(error, self.packages) from error
        try:
            mitsuba.set_variant(options.variant)
        except ImportError as error:
            raise Failure(f"expected one of {', '.join(mitsuba.variants())} as --variant, found {options.variant}: {error}") from error
        words = scene_dictionary(scene, *options.size, options.sampler, folder,
                                 lambda *view: mitsuba.ScalarTransform4f().look_at(*view))
        title = f"Mitsuba {mitsuba.__version__} path, {options.variant}, {options.sampler}"
        return MitsubaScene(mitsuba, drjit, words, title, options.threads)
