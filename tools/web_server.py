#!/usr/bin/env python3
"""Serves a folder on a free port of this machine, which it prints; with a file's name too, it writes there what the first POST holds, and ends.

    python3 tools/web_server.py FOLDER [FILE]
"""

import functools
import http.server
import sys


class Handler(http.server.SimpleHTTPRequestHandler):
    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        self.send_response(204)
        self.end_headers()
        self.server.posted = body

    def log_message(self, *arguments):
        pass


folder = sys.argv[1]
server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Handler, directory=folder))
server.daemon_threads = True
server.posted = None
server.timeout = 0.2
print(server.server_address[1], flush=True)
if len(sys.argv) > 2:
    while server.posted is None:
        server.handle_request()
    with open(sys.argv[2], "wb") as file:
        file.write(server.posted)
else:
    server.serve_forever()
