"""Types of the parts of a report, for type checkers and editors."""

from typing import Optional

from ._fields import Fields as Fields

class Segments(Fields):
    fit: float
    selection: float
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
    not_identified: Optional[Refusal]

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
    excluded_s: float
    unit: Optional[str]
    output_std: float

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
    exported_model: Optional[Fields]

class Share(Fields):
    value: float
    quartiles: list[float]

class Shares(Fields):
    alone: Share
    beyond_others: Share

class Knot(Fields):
    at: float
    value: float
    ci95: Optional[list[float]]

class Curve(Fields):
    over: str
    unit: Optional[str]
    points: list[Knot]

class Lack(Fields):
    mechanism: str
    channel: str
    title: str
    share: Shares
    confidence: str
    alternatives: list[str]
    curve: Curve
    members: list[str]
    described_by: list[DescribedBy]

class DescribedBy(Fields):
    effects: list[str]
    error_ratio: float

class Finding(Fields):
    severity: str
    words: str
    code: str
    evidence: Fields

class LackAlone(Fields):
    mechanism: str
    channel: str
    title: str
    share: Share
    confidence: str

class FileAlone(Fields):
    path: str
    lacks: Optional[list[LackAlone]]

class Complete(Fields):
    floors: Optional[float]
    at_floor: bool

class Term(Fields):
    family: str
    effect: str
    channel: str
    confidence: str
    coefficients: list[Coefficient]
    p: Optional[float]
    explained: float
    explained_by_file: list[Fields]
    alternatives: list[Fields]
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
