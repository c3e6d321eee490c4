"""Types of the parts of a report, for type checkers and editors."""

from typing import Optional

from ._fields import Fields as Fields

class Segments(Fields):
    fit: float
    stop: float
    held_out: float

class Coefficient(Fields):
    name: str
    value: float
    unit: Optional[str]
    ci95: Optional[list[float]]

class Refusal(Fields):
    reason: str
    excitation: str

class Parameter(Coefficient):
    identified: bool
    refused: Optional[Refusal]

class RecordPart(Fields):
    path: str
    samples: int
    dropped: int
    rate_hz: float
    mode: str
    cutoff_hz: float
    blocks: int
    held_out: str

class CheckedRecord(Fields):
    path: str
    samples: int
    rate_hz: float
    mode: str
    cutoff_hz: float
    left_out_s: float
    unit: Optional[str]
    deviation: float

class ModelPart(Fields):
    effects: list[str]
    parameters: list[Parameter]
    rmse: Segments
    nrmse: Segments
    nrmse_raw: Segments

class FinalPart(Fields):
    effects: list[str]
    refitted: bool
    parameters: list[Parameter]
    rmse: Segments
    nrmse: Segments
    causal_nrmse: Optional[Segments]
    feed_forward: Fields
    handed_over: Optional[Fields]

class Round(Fields):
    family: str
    effect: str
    channel: str
    grade: str
    support: Fields
    coefficients: list[Coefficient]
    p: Optional[float]
    explained: float
    confounded_with: list[Fields]
    experiment: Optional[Fields]
    rmse_before: Segments
    rmse_after: Segments
    raises_held_out: bool
    model: Fields
    models: list[Fields]
    refitted: bool
    not_refitted_without: str
    nrmse: Segments

class Rejected(Fields):
    family: str
    effect: str
    channel: str
    gate: str

class Defect(Fields):
    kind: str
    channel: str
    ranges: list[list[int]]
    message: str

class Fitted(Fields):
    value: float
    ci95: Optional[list[float]]

class Cost(Fields):
    evaluations: int
    jacobians: int
    columns_filtered: int
    searches: int
    seconds: Fields
