// A small engine that embeds Arealight: its own device, memory, G-buffer and command buffer.
//
//     host PICTURE.pfm [--recorder] [--tiles] [--validate core|synchronization|gpu-assisted] [--mistake]
//
// Renders a floor under four lights and writes its radiance: by what owns all that shading needs, or with --recorder by what is below it.
// With --tiles, each tile is shaded with the lights that contribute to it. With
// --validate it fails if the validation layer has a message; with --mistake it makes one, to show that this would be noticed.

#include "engine.hpp"

#include <arealight.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <set>

namespace {

// doc: check
// Every call of Arealight that fails says why
void check(ArealightResult result) {
    if (result != AREALIGHT_RESULT_OK) {
        throw std::runtime_error(arealight_last_error());
    }
}
// doc end

// Vulkan's non-dispatchable handles as the numbers that Arealight takes: pointers or integers, by the platform.
template <class Handle> uint64_t number(Handle handle) {
    return (uint64_t)handle;
}

// What the camera sees of a floor, 1.5 below it: rougher to the right, metal in every other strip.
struct Surfaces {
    std::vector<float> position, normal;
    std::vector<uint8_t> base_color;

    Surfaces() {
        for (uint32_t y = 0; y < HEIGHT; y++) {
            for (uint32_t x = 0; x < WIDTH; x++) {
                float right = ((float)x + 0.5f) / (float)WIDTH * 2.0f - 1.0f;
                float up = 0.4f - ((float)y + 0.5f) / (float)HEIGHT;
                bool hit = up < 0.0f;
                float distance = hit ? 1.5f / -up : 0.0f;
                position.insert(position.end(),
                                {right * distance, up * distance, -1.5f * distance, hit ? 1.0f : 0.0f});
                normal.insert(normal.end(), {0.0f, 1.0f, 0.0f, 0.05f + 0.9f * ((float)x / (float)WIDTH)});
                uint8_t metalness = y / 16 % 2 ? 255 : 0;
                base_color.insert(base_color.end(), {200, 180, 150, metalness});
            }
        }
    }
};

// Writes radiance as a Portable Float Map: three channels, rows from the bottom.
void write_picture(const char *path, const float *radiance) {
    std::ofstream file(path, std::ios::binary);
    file << "PF\n" << WIDTH << " " << HEIGHT << "\n-1.0\n";
    for (uint32_t row = HEIGHT; row-- > 0;) {
        for (uint32_t x = 0; x < WIDTH; x++) {
            file.write((const char *)(radiance + 4 * (row * WIDTH + x)), 3 * sizeof(float));
        }
    }
    if (!file.flush()) {
        throw std::runtime_error(std::string(path) + ": cannot write");
    }
}

// doc: light_kinds
// A light of a few corners, counter-clockwise from its front
ArealightLight polygon(const char *name, const double *vertices, uint32_t count, const std::array<float, 3> &radiance) {
    ArealightLight light = {};
    light.name = name;
    light.kind = AREALIGHT_LIGHT_POLYGON;
    light.vertices = vertices;
    light.vertex_count = count;
    std::copy(radiance.begin(), radiance.end(), light.radiance);
    return light;
}

ArealightLight sphere(const char *name, const std::array<double, 3> &center, double radius,
                      const std::array<float, 3> &radiance) {
    ArealightLight light = {};
    light.name = name;
    light.kind = AREALIGHT_LIGHT_SPHERE;
    light.radius = radius;
    std::copy(center.begin(), center.end(), light.center);
    std::copy(radiance.begin(), radiance.end(), light.radiance);
    return light;
}
// doc end

int render(const char *path, const std::string &validation, const std::set<std::string> &options) {
    const bool recorder = options.count("--recorder"), tiles = options.count("--tiles");
    Engine engine(validation);
    VkDevice device = engine.device;

    // doc: host
    // Your Vulkan
    ArealightHost host = {};
    host.abi_version = AREALIGHT_ABI_VERSION;
    host.api_version = VK_API_VERSION_1_1;
    host.get_instance_proc_addr = (ArealightProcAddr)vkGetInstanceProcAddr;
    host.get_device_proc_addr = (ArealightProcAddr)vkGetDeviceProcAddr;
    host.instance = engine.instance;
    host.physical_device = engine.physical_device;
    host.device = device;
    // doc end
    // doc: first
    // Once: all zero is exact, for both lobes and every light
    ArealightAreaLightsInfo info = {};
    info.options.tile_capacity = tiles ? 128 : 0; // for many lights: lists of up to so many for each tile of 8 x 8 pixels
    ArealightAreaLights *area_lights = nullptr;
    check(arealight_area_lights_create(&host, &info, &area_lights));
    // doc end

    // doc: create
    // Once: the recorder on your device
    Arealight *arealight = nullptr;
    check(arealight_create(&host, nullptr, &arealight));

    // Memory for its table, which is yours
    ArealightMemory needed;
    check(arealight_table_memory(arealight, &needed));
    VkDeviceMemory table_memory = engine.allocate(needed.size, needed.memory_type_bits, 0);
    Buffer table_staging = engine.buffer(needed.staging_size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);

    ArealightPass *pass = nullptr;
    check(arealight_pass_create(arealight, &info.options, &pass));
    // doc end

    // doc: lights
    // In world positions; those of the G-buffer are relative to the camera
    const double camera[3] = {1000.0, 1.5, -2000.0};
    const double window[] = {994.0, 0.2, -2011.0, 998.0, 0.2, -2012.0, 998.0, 3.2, -2012.0, 994.0, 3.2, -2011.0};
    const double sign[] = {1003.0, 0.1, -2010.0, 1006.0, 0.1, -2008.0, 1004.5, 2.1, -2009.0};
    const double arrow[] = {999.0, 0.5, -2009.0, 1002.0, 0.5, -2009.0, 1002.0, 2.0, -2009.0,
                            1000.5, 1.0, -2009.0, 999.0, 2.0, -2009.0};
    ArealightLight lights[4] = {polygon("window", window, 4, {3.0f, 3.5f, 4.0f}),
                                polygon("sign", sign, 3, {6.0f, 1.0f, 0.5f}),
                                polygon("arrow", arrow, 5, {0.5f, 5.0f, 1.0f}),
                                sphere("lamp", {996.0, 0.5, -2007.0}, 0.3, {8.0f, 6.0f, 2.0f})};
    lights[1].two_sided = 1;
    // doc end
    // doc: pack
    // When lights change: pack them relative to an origin near the camera, and upload
    ArealightPackedLights packed = {};
    check(arealight_pack_lights(lights, 4, camera, &packed)); // the sizes
    Buffer light_buffer = engine.buffer(packed.lights_size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    Buffer vertex_buffer = engine.buffer(packed.vertices_size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    Buffer shape_buffer = engine.buffer(packed.shapes_size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    packed.lights = light_buffer.mapped;
    packed.vertices = vertex_buffer.mapped;
    packed.shapes = shape_buffer.mapped;
    check(arealight_pack_lights(lights, 4, camera, &packed));
    // doc end

    // With tiles: where the horizons of the table's lobes are, once, and a buffer for the lists of each frame in flight
    Buffer lobe_horizons = {}, tile_lists = {};
    if (tiles) {
        uint64_t horizon_size = 0;
        check(arealight_lobe_horizons(arealight, AREALIGHT_SPECULAR_LOBES_ONE, nullptr, &horizon_size));
        lobe_horizons = engine.buffer(horizon_size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
        check(arealight_lobe_horizons(arealight, AREALIGHT_SPECULAR_LOBES_ONE, lobe_horizons.mapped, &horizon_size));
        ArealightTileMemory lists;
        check(arealight_pass_tile_memory(pass, WIDTH, HEIGHT, &lists));
        tile_lists = engine.buffer(lists.size, lists.usage);
    }

    // The engine's own G-buffer
    Surfaces surfaces;
    const VkImageUsageFlags sampled = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    Image g_buffer[3] = {engine.image(VK_FORMAT_R32G32B32A32_SFLOAT, sampled),
                         engine.image(VK_FORMAT_R32G32B32A32_SFLOAT, sampled),
                         engine.image(VK_FORMAT_R8G8B8A8_UNORM, sampled)};
    const uint64_t float_bytes = 16 * WIDTH * HEIGHT, byte_bytes = 4 * WIDTH * HEIGHT;
    Buffer staging[3] = {engine.buffer(float_bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, surfaces.position.data()),
                         engine.buffer(float_bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, surfaces.normal.data()),
                         engine.buffer(byte_bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, surfaces.base_color.data())};
    Image radiance = engine.image(VK_FORMAT_R32G32B32A32_SFLOAT,
                                  VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    Buffer readback = engine.buffer(float_bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT);

    // The recorder's descriptor set, from a pool of the engine's
    ArealightSetLayout layout;
    check(arealight_pass_set_layout(pass, &layout));
    const VkDescriptorPoolSize sizes[] = {
        {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, layout.sampled_images},
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, layout.combined_image_samplers},
        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, layout.storage_images},
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, layout.storage_buffers},
    };
    const VkDescriptorPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, nullptr, 0, 1, 4, sizes};
    VkDescriptorPool pool;
    check(vkCreateDescriptorPool(device, &pool_info, nullptr, &pool), "vkCreateDescriptorPool");
    VkDescriptorSetLayout set_layout = (VkDescriptorSetLayout)layout.layout;
    const VkDescriptorSetAllocateInfo set_info = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, pool, 1, &set_layout};
    VkDescriptorSet set;
    check(vkAllocateDescriptorSets(device, &set_info, &set), "vkAllocateDescriptorSets");

    const VkCommandPoolCreateInfo commands_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, engine.family};
    VkCommandPool command_pool;
    check(vkCreateCommandPool(device, &commands_info, nullptr, &command_pool), "vkCreateCommandPool");
    const VkCommandBufferAllocateInfo allocate_info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, command_pool,
                                                       VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    VkCommandBuffer commands;
    check(vkAllocateCommandBuffers(device, &allocate_info, &commands), "vkAllocateCommandBuffers");
    VkCommandBufferBeginInfo begin_info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    check(vkBeginCommandBuffer(commands, &begin_info), "vkBeginCommandBuffer");

    // doc: upload
    // Once: the table
    check(arealight_table_bind_memory(arealight, number(table_memory), 0)); // sets may be written from here on
    ArealightUpload upload = {};
    upload.staging_data = table_staging.mapped;
    upload.staging_size = needed.staging_size;
    upload.staging_buffer = number(table_staging.handle);
    upload.command_buffer = commands;
    check(arealight_table_upload(arealight, &upload));
    // doc end

    const VkPipelineStageFlags compute = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, copy = VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkPipelineStageFlags start = VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT;
    const VkBufferImageCopy region = whole_image();
    for (int i = 0; i < 3; i++) {
        VkImage image = g_buffer[i].handle;
        barrier(commands, image, start, 0, VK_IMAGE_LAYOUT_UNDEFINED, copy, VK_ACCESS_TRANSFER_WRITE_BIT,
                VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        vkCmdCopyBufferToImage(commands, staging[i].handle, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        // With --mistake, the images are left in the wrong layout
        if (!options.count("--mistake")) {
            barrier(commands, image, copy, VK_ACCESS_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, compute,
                    VK_ACCESS_SHADER_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        }
    }
    barrier(commands, radiance.handle, start, 0, VK_IMAGE_LAYOUT_UNDEFINED, compute, VK_ACCESS_SHADER_WRITE_BIT,
            VK_IMAGE_LAYOUT_GENERAL);
    // doc: frame
    // Each frame: its size and your images
    ArealightFrame frame = {}; // frame.camera stays zero: the origin is the camera's position
    frame.width = WIDTH;
    frame.height = HEIGHT;
    ArealightResources resources = {};
    for (uint32_t plane = 0; plane < 3; plane++) { // AREALIGHT_PLANE_POSITION, _NORMAL, _BASE_COLOR
        resources.planes[plane] = {number(g_buffer[plane].view), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, 0};
    }
    resources.radiance = {number(radiance.view), VK_IMAGE_LAYOUT_GENERAL, 0};
    if (!recorder) { // for the first place of those in flight
        check(arealight_area_lights_shade(area_lights, commands, 0, lights, 4, camera, &frame, &resources));
    }
    // doc end
    // doc: record
    // Each frame: point the set at your buffers, too, and record between barriers of yours
    resources.lights = {number(light_buffer.handle), 0, AREALIGHT_WHOLE_SIZE};
    resources.light_vertices = {number(vertex_buffer.handle), 0, AREALIGHT_WHOLE_SIZE};
    resources.shapes = {number(shape_buffer.handle), 0, AREALIGHT_WHOLE_SIZE};
    resources.lobe_horizons = {number(lobe_horizons.handle), 0, AREALIGHT_WHOLE_SIZE}; // these two with tiles alone
    resources.tile_lists = {number(tile_lists.handle), 0, AREALIGHT_WHOLE_SIZE};
    check(arealight_pass_write_set(pass, arealight, number(set), &resources));
    frame.lights = packed.summary;
    frame.tile_lists = resources.tile_lists;
    if (recorder) {
        check(arealight_pass_record(pass, commands, number(set), &frame));
    }
    // doc end
    barrier(commands, radiance.handle, compute, VK_ACCESS_SHADER_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL, copy,
            VK_ACCESS_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    vkCmdCopyImageToBuffer(commands, radiance.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, readback.handle, 1,
                           &region);
    const VkMemoryBarrier to_host = {VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_TRANSFER_WRITE_BIT,
                                     VK_ACCESS_HOST_READ_BIT};
    vkCmdPipelineBarrier(commands, copy, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &to_host, 0, nullptr, 0, nullptr);
    check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");

    const VkSubmitInfo submit = {VK_STRUCTURE_TYPE_SUBMIT_INFO, nullptr, 0, nullptr, nullptr, 1, &commands, 0, nullptr};
    check(vkQueueSubmit(engine.queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
    check(vkQueueWaitIdle(engine.queue), "vkQueueWaitIdle");
    write_picture(path, (const float *)readback.mapped);

    // doc: last
    // When no commands are pending
    check(arealight_area_lights_destroy(area_lights));
    // doc end
    check(arealight_pass_destroy(pass));
    check(arealight_destroy(arealight));
    vkDestroyCommandPool(device, command_pool, nullptr);
    vkDestroyDescriptorPool(device, pool, nullptr);
    return engine.close();
}

} // namespace

int main(int argc, char **argv) {
    std::string path, validation;
    std::set<std::string> options;
    for (int i = 1; i < argc; i++) {
        std::string argument = argv[i];
        if (argument == "--validate" && i + 1 < argc) {
            validation = argv[++i];
        } else if (argument.compare(0, 2, "--") == 0) {
            options.insert(argument);
        } else {
            path = argument;
        }
    }
    if (path.empty()) {
        std::fprintf(stderr, "usage: %s PICTURE.pfm, and what examples/cpp/host.cpp begins with\n", argv[0]);
        return 2;
    }
    try {
        int messages = render(path.c_str(), validation, options);
        if (messages > 0) {
            std::fprintf(stderr, "error: the validation layer has %d messages\n", messages);
            return 1;
        }
    } catch (const std::exception &error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 1;
    }
    std::printf("wrote %s\n", path.c_str());
    return 0;
}
