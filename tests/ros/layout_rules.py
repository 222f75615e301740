# SPDX-License-Identifier: MIT
"""What the panels of a Foxglove layout may be told: the configuration types of Lichtblick, which continues Foxglove
Studio in the open (packages/suite-base/src/panels), written down as a checker."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

Rule = Callable[[Any], bool]


def number(value: Any) -> bool:
    """A number, and no truth value."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def text(value: Any) -> bool:
    """A string."""
    return isinstance(value, str)


def truth(value: Any) -> bool:
    """True or false."""
    return isinstance(value, bool)


def one_of(*words: str) -> Rule:
    """One of some strings."""
    return lambda value: value in words


def list_of(rule: Rule, count: int | None = None) -> Rule:
    """A list, each item by a rule."""
    return lambda value: (
        isinstance(value, list) and count in (None, len(value)) and all(rule(item) for item in value)
    )


def map_of(rule: Rule) -> Rule:
    """An object whose values are by a rule, whatever their keys."""
    return lambda value: isinstance(value, dict) and all(rule(item) for item in value.values())


def record(needed: Mapping[str, Rule], optional: Mapping[str, Rule] | None = None) -> Rule:
    """An object with these members and no other."""
    rules = {**needed, **(optional or {})}

    def holds(value: Any) -> bool:
        return (
            isinstance(value, dict)
            and needed.keys() <= value.keys() <= rules.keys()
            and all(rules[key](item) for key, item in value.items())
        )

    return holds


TITLES: Final = {"foxglovePanelTitle": text, "lichtblickPanelTitle": text}
_SERIES: Final = record(
    {"value": text, "enabled": truth, "timestampMethod": one_of("receiveTime", "headerStamp")},
    {"color": text, "label": text, "showLine": truth, "lineSize": number},
)
_STATES: Final = record(
    {"value": text, "timestampMethod": one_of("receiveTime", "headerStamp")},
    {"color": text, "label": text, "enabled": truth},
)
_CAMERA: Final = record(
    {
        "perspective": truth,
        **dict.fromkeys(("distance", "phi", "thetaOffset", "fovy", "near", "far"), number),
        "target": list_of(number, 3),
        "targetOffset": list_of(number, 3),
        "targetOrientation": list_of(number, 4),
    }
)
_GRID: Final = record(
    {
        "instanceId": text,
        "layerId": one_of("foxglove.Grid"),
        "label": text,
        "visible": truth,
        "frameLocked": truth,
        **dict.fromkeys(("size", "divisions", "lineWidth", "order"), number),
        "color": text,
        "position": list_of(number, 3),
        "rotation": list_of(number, 3),
    }
)
_TOPIC: Final = record({"visible": truth}, {"type": one_of("axis", "arrow", "line")})
PANELS: Final[Mapping[str, Rule]] = {
    "3D": record(
        {
            "cameraState": _CAMERA,
            "followTf": text,
            "followMode": one_of("follow-pose", "follow-position", "follow-none"),
            "scene": record({}, {"transforms": record({}, {"axisScale": number, "showLabel": truth})}),
            "transforms": map_of(record({"visible": truth})),
            "topics": map_of(_TOPIC),
            "layers": map_of(_GRID),
        },
        TITLES,
    ),
    "Plot": record(
        {
            "paths": list_of(_SERIES),
            **dict.fromkeys(
                ("showLegend", "showPlotValuesInLegend", "showXAxisLabels", "showYAxisLabels", "isSynced"),
                truth,
            ),
            "legendDisplay": one_of("floating", "top", "left", "none"),
            "xAxisVal": one_of("timestamp", "index", "custom", "currentCustom"),
            "sidebarDimension": number,
        },
        {**dict.fromkeys(("minYValue", "maxYValue", "followingViewWidth"), number), **TITLES},
    ),
    "StateTransitions": record(
        {"isSynced": truth, "paths": list_of(_STATES)}, {"showPoints": truth, **TITLES}
    ),
    "RawMessages": record(
        {
            "diffEnabled": truth,
            "diffMethod": one_of("custom", "previous message"),
            "diffTopicPath": text,
            "showFullMessageForDiff": truth,
            "topicPath": text,
        },
        {"expansion": one_of("all", "none"), **TITLES},
    ),
    "Indicator": record(
        {
            "path": text,
            "style": one_of("bulb", "background"),
            "fallbackColor": text,
            "fallbackLabel": text,
            "rules": list_of(
                record(
                    {
                        "color": text,
                        "label": text,
                        "operator": one_of("=", "<", "<=", ">", ">="),
                        "rawValue": text,
                    }
                )
            ),
        },
        TITLES,
    ),
    "Gauge": record(
        {
            "path": text,
            "minValue": number,
            "maxValue": number,
            "colorMap": one_of("red-yellow-green", "rainbow", "turbo"),
            "colorMode": one_of("colormap", "gradient"),
            "gradient": list_of(text, 2),
            "reverse": truth,
        },
        TITLES,
    ),
    "RosOut": record(
        {"searchTerms": list_of(text), "minLogLevel": number},
        {"topicToRender": text, "nameFilter": map_of(record({}, {"visible": truth})), **TITLES},
    ),
}


def mosaic(node: Any) -> bool:
    """How panels share the window: a panel, or two parts beside or above one another."""
    if isinstance(node, str):
        return True
    split = record(
        {"direction": one_of("row", "column"), "first": mosaic, "second": mosaic}, {"splitPercentage": number}
    )
    return split(node)


LAYOUT: Final = record(
    {
        "configById": map_of(lambda value: isinstance(value, dict)),
        "layout": mosaic,
        "globalVariables": map_of(lambda _: True),
        "playbackConfig": record({"speed": number}),
    },
    {"userNodes": map_of(lambda _: True), "version": number},
)
