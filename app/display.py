"""What a visitor's pictures are shown with: everything that changes the view of a run, nothing of the run."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

FIRST_TRANSFER = "phi/dv_r"


def _known_transfer(id: str) -> str:
    from app.figures.frequency import TRANSFERS

    if id not in TRANSFERS:
        raise ValueError(f"must be one of {', '.join(TRANSFERS)}")
    return id


class Display(BaseModel):
    """Choices of how a session's pictures look; saved with the session.

    Attributes
    ----------
    transfer : str
        Transfer shown in the Bode plot: a key of `app.figures.frequency.TRANSFERS`.
    exaggeration : float or None
        Of the errors in 3D; None: chosen to fit.
    angle, length, speed, time : str
        Unit of the plots over time and of the tables; "auto": what fits the numbers.
    scale : str
        Axis of the errors over time.
    theme : str
        Of the whole page.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    transfer: Annotated[str, AfterValidator(_known_transfer)] = FIRST_TRANSFER
    exaggeration: Annotated[float | None, Field(gt=0.0, le=1e6)] = None
    angle: Literal["auto", "arcsec", "arcmin", "deg"] = "auto"
    length: Literal["auto", "m", "km", "nmi"] = "auto"
    speed: Literal["auto", "m/s", "kn"] = "auto"
    time: Literal["auto", "min", "h"] = "auto"
    scale: Literal["linear", "log"] = "linear"
    theme: Literal["light", "dark"] = "light"

    def with_(self, **changes: object) -> Display:
        """Give a checked copy with other choices; raises `pydantic.ValidationError`."""
        return Display.model_validate(self.model_dump() | changes)
