"""Numbers for reading: rounded, with powers of ten where they help."""

import math

_THIN_SPACE = "\u202f"
_SPACE = "\u00a0"  # no line breaks here
_MINUS = "\u2212"
_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def number(value: float, digits: int = 3) -> str:
    """Formats `value` in this many significant digits; whole numbers (int) in full, with separated thousands."""
    if isinstance(value, int):
        return _signed(f"{value:,}".replace(",", _THIN_SPACE))
    if not math.isfinite(value):
        return "–" if math.isnan(value) else _signed(f"{value}").replace("inf", "∞")
    exponent = _exponent(value, digits)
    return _signed(_scaled(value, exponent, digits - 1 - _magnitude(value, digits)) + _power(exponent))


def spread(mean: float, std: float, digits: int = 3) -> str:
    """Formats mean and standard deviation to the same decimal, over a common power of ten."""
    if not (math.isfinite(mean) and math.isfinite(std)):
        return number(mean, digits)
    exponent = _exponent(mean, digits)
    decimals = digits - 1 - _magnitude(mean, digits)
    both = f"{_scaled(mean, exponent, decimals)}{_SPACE}±{_SPACE}{_scaled(std, exponent, decimals)}"
    return _signed(f"({both}){_power(exponent)}" if exponent else both)


def brief(value: float) -> str:
    """Formats `value` in as few digits as it needs: a round number, for example a tick."""
    digits = f"{value:.9e}".partition("e")[0].replace(".", "").strip("-0")
    return number(value, len(digits) or 1)


def superscript(exponent: int) -> str:
    """Formats an exponent as in 10⁻³."""
    return str(exponent).translate(_SUPERSCRIPT)


def _magnitude(value: float, digits: int) -> int:
    """Returns the power of ten of the first digit, after rounding: 0.9996 in three digits is 1.00."""
    return int(f"{value:.{digits - 1}e}".partition("e")[2]) if value else 0


def _exponent(value: float, digits: int) -> int:
    """Returns the power of ten to factor out: 0 for numbers that read well without."""
    magnitude = _magnitude(value, digits)
    return 0 if -3 <= magnitude < 7 else magnitude


def _scaled(value: float, exponent: int, decimals: int) -> str:
    return f"{value / 10.0**exponent:,.{max(decimals + exponent, 0)}f}".replace(",", _THIN_SPACE)


def _power(exponent: int) -> str:
    return f"{_SPACE}×{_SPACE}10{superscript(exponent)}" if exponent else ""


def _signed(text: str) -> str:
    return text.replace("-", _MINUS)
