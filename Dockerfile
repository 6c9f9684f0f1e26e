# Schuler Bench as a container:
#
#   docker build -t schuler-bench .
#   docker run --init --read-only -e SCHULER_TOKEN_FILE=/run/token -v $PWD/token:/run/token:ro \
#     -v schuler-data:/data -p 127.0.0.1:8080:8080 schuler-bench
#
# User 10001 must be able to read the token: chown 10001 token && chmod 0400 token.
# Published on another port or under another name, it is told so: -e SCHULER_ALLOW_ORIGIN=http://localhost:9000.
# deploy/compose.yml puts a proxy with TLS before it.
#
# The base is an image index for all platforms, with Python 3.11.16. Its digest comes from the record that Docker keeps
# of its official images (docker-library/repo-info, 25 August 2026). To renew it, write what this prints into both stages:
#   docker buildx imagetools inspect python:3.11-slim-bookworm
# tests/extension/test_image.py reads this file, and builds the image where a Docker engine answers.

FROM python:3.11-slim-bookworm@sha256:0bee7276f83efd4a1ee05bbbf4281d95ed28e079220a9457f25a93e3f1e3c31b AS builder
WORKDIR /src

COPY requirements/run.lock requirements/build.lock requirements/
RUN python -m venv --without-pip /opt/schuler \
 && python -m pip --python /opt/schuler/bin/python install --require-hashes --only-binary :all: -r requirements/run.lock
RUN python -m pip install --require-hashes --only-binary :all: -r requirements/build.lock

COPY pyproject.toml README.md LICENSE ./
COPY app/ app/
COPY assets/ assets/
COPY navcore/ navcore/
RUN python -m pip wheel --no-deps --no-index --no-build-isolation --wheel-dir /wheels . \
 && python -m pip --python /opt/schuler/bin/python install --no-deps --no-index /wheels/*.whl

# Machine code is kept for the processor that compiled it. On another one the first start compiles anew, into /data.
# Root compiles, and the user schuler reads: the first start copies the kernels to /data.
# Away from the sources: the cache is tied to the path of the installed modules.
WORKDIR /opt/schuler
ENV SCHULER_CACHE_DIR=/opt/schuler-kernels
RUN mkdir -p /opt/schuler-kernels && /opt/schuler/bin/python -m navcore.warm


FROM python:3.11-slim-bookworm@sha256:0bee7276f83efd4a1ee05bbbf4281d95ed28e079220a9457f25a93e3f1e3c31b
RUN python -m pip uninstall --yes pip setuptools wheel
RUN useradd --system --uid 10001 --home-dir /data --shell /usr/sbin/nologin schuler
RUN install -d -o schuler -g schuler /data

# The same paths as in the builder: the kernel cache is tied to them.
COPY --from=builder /opt/schuler /opt/schuler
COPY --from=builder /opt/schuler-kernels /opt/schuler-kernels

# All that is ever written goes below /data, so the root may be read-only.
ENV PATH=/opt/schuler/bin:$PATH \
    HOME=/data \
    TMPDIR=/data \
    SCHULER_CACHE_DIR=/opt/schuler-kernels \
    PYTHONDONTWRITEBYTECODE=1
USER schuler
WORKDIR /data
VOLUME ["/data"]
EXPOSE 8080

HEALTHCHECK --interval=30s --timeout=5s --start-period=60s --retries=3 \
    CMD ["python", "-c", "import urllib.request; urllib.request.urlopen('http://127.0.0.1:8080/healthz', timeout=4)"]

# Beyond loopback the server refuses to start without a token: pass it as SCHULER_TOKEN, not on the command line.
CMD ["schuler", "serve", "--host", "0.0.0.0", "--port", "8080"]
