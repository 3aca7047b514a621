"""What does a robot gain from knowing which of its joints has failed?"""
