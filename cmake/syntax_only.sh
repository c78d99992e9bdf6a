#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# syntax_only.sh COMPILER ARGUMENTS... -o FILE ...: the compiler checks its input and makes no code, which
# takes three quarters of the time. FILE, empty, says when.
set -eu
"$@" -fsyntax-only
while [ "$1" != -o ]; do shift; done
: >"$2"
