# SPDX-License-Identifier: Apache-2.0
"""What clrt-mitsuba needs of the package drjit, beside the mitsuba of this folder."""


def eval(*_):
    pass


def sync_thread():
    pass


def set_thread_count(count):
    global threads
    threads = count


def thread_count():
    return threads


threads = 2
