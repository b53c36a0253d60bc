"""What theorems inherit: a certificate, sealed by a digest, that a checker verifies on its own."""

from __future__ import annotations

import json
from abc import abstractmethod
from pathlib import Path
from typing import Any, ClassVar

from symfpu.files.archive import Json, digest_of
from symfpu.files.writing import write_text
from symfpu.numbers.public import public
from symfpu.results.result import BY_CERTIFICATE, Tabled

COMPACT = (",", ":")


@public
class Certified(Tabled):
    """A theorem that comes with a certificate."""

    not_kept = BY_CERTIFICATE
    layout: ClassVar[dict[str, Any]] = {"separators": COMPACT}  # of its JSON

    @abstractmethod
    def _certificate_body(self) -> Json:
        """Integers, strings, lists and dictionaries: all but the digest."""

    def certificate(self) -> dict[str, Any]:
        """What `symfpu verify` needs to check the theorem again, as JSON holds it.

        Integers, strings, lists and dictionaries, with a digest of all of them.
        """
        body = self._certificate_body()
        return body | {"digest": digest_of(body)}

    def write(self, path: Path | str) -> None:
        """Write the certificate to a path as JSON, whole or not at all.

        Raises InputError if the file cannot be written.
        """
        text = json.dumps(self.certificate(), **self.layout)
        write_text(Path(path), text + "\n")
