"""Keywords of the languages of ROS 2 nodes, which generated names must avoid.

Source: ISO/IEC 9899:1999, 6.4.1, and ISO/IEC 14882:2017 and 14882:2020, [lex.key].
"""

from __future__ import annotations

import keyword

_C = """auto break case char const continue default do double else enum extern float for goto if
inline int long register restrict return short signed sizeof static struct switch typedef union
unsigned void volatile while"""
_ONLY_CPP = """alignas alignof and and_eq asm bitand bitor bool catch char16_t char32_t class compl
const_cast constexpr decltype delete dynamic_cast explicit export false friend mutable namespace
new noexcept not not_eq nullptr operator or or_eq private protected public reinterpret_cast
static_assert static_cast template this thread_local throw true try typeid typename using virtual
wchar_t xor xor_eq"""
_ONLY_CPP_20 = "char8_t co_await co_return co_yield concept consteval constinit requires"

C = frozenset(_C.split())
"""C99, without the words that begin with an underscore."""

CPP = (C - {"restrict"}) | frozenset(_ONLY_CPP.split())
"""C++17, which ROS 2 Jazzy is built with."""

CPP_20 = CPP | frozenset(_ONLY_CPP_20.split())
"""C++20, which a package may choose."""

PYTHON = frozenset(keyword.kwlist)
"""The Python that runs deros."""

NO_ARGUMENT = PYTHON | {"when", "true", "false", "this_dir"}
"""What no argument of a system is called: words of conditions, and of Python for its script."""
