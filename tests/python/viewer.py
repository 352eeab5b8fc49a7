"""A viewer that takes pictures over the network: what --display-server talks to."""
import socket
import struct
import threading


class Viewer:
    """Stands in for tev: notes what it is sent. A message is its length, its kind (3 updates a picture, 4 makes one), and the
    rest as https://github.com/Tom94/tev describes it."""

    def __init__(self):
        self.server = socket.create_server(("127.0.0.1", 0))
        self.address = "127.0.0.1:%d" % self.server.getsockname()[1]
        self.made, self.updates = [], []
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        while True:
            try:
                connection, _ = self.server.accept()
            except OSError:
                return
            with connection, connection.makefile("rb") as stream:
                while (head := stream.read(4)):
                    self.take(stream.read(struct.unpack("<I", head)[0] - 4))

    def take(self, message):
        kind, rest = message[0], message[2:]
        name, rest = rest.split(b"\0", 1)
        if kind == 4:
            self.made.append((name.decode(), *struct.unpack("<2i", rest[:8])))
        elif kind == 3:
            channel, rest = rest.split(b"\0", 1)
            self.updates.append((channel.decode(), struct.unpack("<4i", rest[:16]), rest[16:]))

    def close(self):
        self.server.close()
