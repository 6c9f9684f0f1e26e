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
# Machine code for a family of processors, into the wheel. On a processor outside it the first start compiles, into /data.
RUN /opt/schuler/bin/python -m navcore.warm portable
RUN python -m pip wheel --no-deps --no-index --no-build-isolation --wheel-dir /wheels . \
 && python -m pip --python /opt/schuler/bin/python install --no-deps --no-index /wheels/*.whl


FROM python:3.11-slim-bookworm@sha256:0bee7276f83efd4a1ee05bbbf4281d95ed28e079220a9457f25a93e3f1e3c31b
RUN python -m pip uninstall --yes pip setuptools wheel
RUN useradd --system --uid 10001 --home-dir /data --shell /usr/sbin/nologin schuler
RUN install -d -o schuler -g schuler /data

# The same path as in the builder: the scripts of a virtual environment are tied to it.
COPY --from=builder /opt/schuler /opt/schuler

# All that is ever written goes below /data, so the root may be read-only.
ENV PATH=/opt/schuler/bin:$PATH \
    HOME=/data \
    TMPDIR=/data \
    PYTHONDONTWRITEBYTECODE=1
USER schuler
WORKDIR /data
VOLUME ["/data"]
EXPOSE 8080

HEALTHCHECK --interval=30s --timeout=5s --start-period=60s --retries=3 \
    CMD ["python", "-c", "import urllib.request; urllib.request.urlopen('http://127.0.0.1:8080/healthz', timeout=4)"]

# Beyond loopback the server refuses to start without a token: pass it as SCHULER_TOKEN, not on the command line.
CMD ["schuler", "serve", "--host", "0.0.0.0", "--port", "8080"]
