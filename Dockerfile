# docker build -t curvcli . && docker run --rm -v "$PWD:/data" curvcli check mesh.ply
# Outputs belong to the user who runs it with --user "$(id -u):$(id -g)".
FROM python:3.12-slim AS build
WORKDIR /source
COPY . .
RUN pip wheel --no-cache-dir --wheel-dir /wheels .

FROM python:3.12-slim
RUN --mount=type=bind,from=build,source=/wheels,target=/wheels \
    pip install --no-cache-dir --no-index /wheels/*.whl \
    && useradd --uid 10001 --no-create-home --shell /usr/sbin/nologin curvcli
ENV PYTHONUNBUFFERED=1
USER 10001
WORKDIR /data
ENTRYPOINT ["curvcli"]
CMD ["--help"]
