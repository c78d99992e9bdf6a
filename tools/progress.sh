# SPDX-License-Identifier: Apache-2.0
# Messages of tools/setup and tools/build, which source this file. Everything goes to stderr.

# Prints a line that stays.
say() {
    [ ! -t 2 ] || printf '\r\033[K' >&2
    echo "tools/$(basename "$0"): $*" >&2
}

progress_quarter=0

# progress PERCENT TEXT: on a terminal the last line, which the next message replaces; elsewhere a line a quarter.
progress() {
    if [ -t 2 ]; then
        printf '\r\033[Ktools/%s: %s' "$(basename "$0")" "$2" >&2
    elif [ $(($1 / 25)) -gt "$progress_quarter" ]; then
        progress_quarter=$(($1 / 25))
        say "$2"
    fi
}

# Removes the line of progress.
progress_end() {
    [ ! -t 2 ] || printf '\r\033[K' >&2
}
