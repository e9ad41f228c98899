class Viewport:
    def __init__(self, engine): pass
    def close(self): pass
