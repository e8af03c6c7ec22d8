"""Values of settings per lock and per hair."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from ringlet.data.curves import Curves
from ringlet.data.mesh import Mesh
from ringlet.data.painted import per_lock
from ringlet.data.quantities import Quantity, Varied
from ringlet.data.random import Random


@dataclass
class Values:
    """Settings of a section evaluated per lock."""

    settings: BaseModel
    locks: Curves
    scalp: Mesh
    seed: int
    section: str  # such as ``hairs.coil``

    def __call__(self, name: str) -> NDArray[np.float64]:
        """Values of a setting, shape (locks,)."""
        random = Random(self.seed, f"{self.section}.{name}".replace(".", "/"))
        return per_lock(self.settings, name, random, self.locks, self.scalp, f"{self.section}.{name}")

    def per_hair(self, name: str, lock: NDArray, ids: NDArray) -> NDArray[np.float64]:
        """Values that vary from hair to hair instead of from lock to lock, shape (hairs,)."""
        setting: Varied = getattr(self.settings, name)
        even = self.settings.model_copy(update={name: setting.model_copy(update={"vary": 0.0})})
        values = Values(even, self.locks, self.scalp, self.seed, self.section)(name)[lock]
        random = Random(self.seed, f"{self.section}.{name}".replace(".", "/"))
        values *= Varied(value=1.0, vary=setting.vary).factors(random, ids, ids)
        return Quantity.of(self.settings, name).clipped(values, setting.peak)
