"""Noise of a picture of hair: root mean square error against one of many samples, in steps of 8 bits."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

import ringlet


def run(samples: str = "12,24,40", reference: int = 512, size: int = 200) -> dict[str, Any]:
    """Takes a lock of the example from near, with and without the denoiser.

    samples:   light paths per pixel, separated by commas
    reference: those of the picture that they are compared with, which is not denoised
    size:      of the picture [pixels]

    ``errors`` has, for each number of samples, ``noisy``, ``denoised``, and the processor time of the latter [s].
    """
    recipe = Path(__file__).parents[1] / "examples" / "child" / "curls.recipe.toml"
    with tempfile.TemporaryDirectory() as name:
        hair, png = Path(name, "hair.usdc"), Path(name, "a.png")
        groom = ringlet.build_groom(recipe)
        ringlet.write_groom(groom, Path(name, "groom.usdc"))
        ringlet.write_hairs(Path(name, "groom.usdc"), hair)
        near = {
            "width": size,
            "height": size,
            "look_at": int(groom.locks.ids[len(groom.locks) // 2]),
            "distance": 0.5,
        }

        def picture(samples: int, denoiser: str) -> np.ndarray:
            ringlet.write_still(hair, png, **near, samples=samples, denoiser=denoiser)
            return np.asarray(Image.open(png).convert("RGB"), float)

        truth = picture(reference, "none")
        errors = {}
        for each in str(samples).split(","):
            noisy = picture(int(each), "none")
            began = time.process_time()
            denoised = picture(int(each), "oidn")
            errors[each] = {"cpu_s": time.process_time() - began} | {
                name: float(np.sqrt(((image - truth) ** 2).mean()))
                for name, image in (("noisy", noisy), ("denoised", denoised))
            }
    return {"params": {"reference": reference, "size": size}, "errors": errors}
