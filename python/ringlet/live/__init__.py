"""Live hair: a groom that moves with its head while it is groomed."""

from ringlet.live.calibration import Calibration, calibrate
from ringlet.live.live import Live, default_contact
from ringlet.live.touch import Touch

__all__ = ["Calibration", "Live", "Touch", "calibrate", "default_contact"]
