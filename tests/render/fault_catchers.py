# SPDX-License-Identifier: Apache-2.0
"""Which test catches which fault of seeded_faults.py."""

# Fault -> the test that catches it in a few seconds: one for each factor that an estimate of light is made of.
QUICK = {
    "dropped cosine": "DirectLight.AQuadLightAboveTheFloorFollowsLambertsFormula",
    "missing 1/p in roulette": "Furnace.RouletteEndsPathsWithoutChangingTheMean",
    "MIS weights do not sum to 1": "DirectLight.ATriangleLightFollowsLambertsFormula",
    "light density off by the count": "LightSampler.EveryChoiceGivesTheSameLightEverywhere",
    "missing eta^2, smooth glass": "Furnace.ASmoothBoundaryOfGlassReflectsAndRefracts",
    "the plane's normal for shading": "ShadingNormal.CornerNormalsAreInterpolated",
    "sampler address used for all bounces": "Interreflection.EveryNumberOfBouncesAgreesWithRadiosity",
    "tent filter as a box": "PixelFilter.ATentFallsOffLinearly",
}


# The same for faults that --quick may draw: the whole test program may take a minute up to the first test that fails.
CAUGHT_BY = {
    "film rounds down": "DirectLight.ATinyFarLightIsNeitherLostNorTooBright",
    "a light sampled for one class lights both": "Paths.MatteAndGlossyOfOneSurfaceAreToldApart",
    "mirrors show the background": "Background.TheCameraSeesItAndNothingElseDoes",
    "fibres denser than their density": "BsdfEnergy.PartGlassPanesAndCoversMakeNoLightAndLoseLittle",
    "the depth of each end alone bounded": "Bidirectional.AClosedFurnaceHasItsSeriesUpToTheWholePathsDepth",
    "light vertices not counted": "Bidirectional.AClosedFurnaceHasItsSeriesUpToTheWholePathsDepth",
    "the power of a kept vertex without its throughput": "Bidirectional.AClosedFurnaceHasItsSeriesUpToTheWholePathsDepth",
    "sampled discs counted twice by a tree of rays": "Distribution.RaysAndShadowRaysShareALightByTheirNumbers",
    "splats of a sample rounded alike": "FilmSplat.EverySplatOfASampleIsRoundedByANumberOfItsOwn",
    "cut paths not counted": "CutPaths.WhiteWallsHaveNoBound",
}
