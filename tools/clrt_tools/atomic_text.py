# SPDX-License-Identifier: Apache-2.0
"""Text files that are there whole or not at all."""
import os


def write_text(path, text):
    """Writes under a temporary name and renames."""
    temporary = f"{path}.{os.getpid()}.tmp"
    try:
        with open(temporary, "w", encoding="utf-8") as file:
            file.write(text)
        os.replace(temporary, path)
    except BaseException:
        if os.path.exists(temporary):
            os.unlink(temporary)
        raise
